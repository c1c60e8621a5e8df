"""Looking through takes before they are converted."""
