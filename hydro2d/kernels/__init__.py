"""One phase of the cycle per file: plain arrays in, plain arrays out."""
