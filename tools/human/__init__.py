"""The human body that is shipped: measures, the shape of its skin, and what moves it."""
