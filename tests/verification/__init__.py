"""The whole code against exact solutions. Expected and obtained values: problems/verification/README.md."""
