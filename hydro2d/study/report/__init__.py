"""The report of a study: tables, figures, pictures, films and the page."""
