"""Runs read back: summaries, fields, figures, exports."""
