"""One file per experiment; the page shows them in this order."""
