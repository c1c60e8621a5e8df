"""What became of takes: kept beside the results, and found there again."""
