"""Conversion of many takes: a pool of worker processes on one queue of jobs, and what became of each take.

`worker_pool` hands the jobs out and retries them, `worker_process` is a worker as the batch sees it, `worker`
the same process from within, `protocol` what the two exchange; `batch_outcomes` stores the outcomes.
Takes that are converted already are skipped in the worker, by `conversion/convert_take`.
"""
