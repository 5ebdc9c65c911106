"""hydro2d/cli: commands, their messages and their statuses."""
