"""The page of a batch: a row a take, those first that need a person first."""
