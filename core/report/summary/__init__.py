"""The HTML page of a batch: a row a take, the takes that need work first."""
