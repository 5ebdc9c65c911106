"""The whole code against exact solutions. What is expected and what was obtained: problems/verification/README.md."""
