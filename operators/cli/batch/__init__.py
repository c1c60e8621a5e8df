"""Conversion of many takes: a pool of worker processes on one queue of jobs, and what became of each take.

`worker_pool` hands the jobs out and retries them, `worker_process` is a worker as the batch sees it, `worker`
the same process from within; `outcomes` stores what became of the takes. Takes that are converted already are
skipped in the worker, by `conversion/convert_take`.
"""
