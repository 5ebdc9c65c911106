"""Studies: many runs from one file, on any number of machines, read back together, and the page that reports them."""
