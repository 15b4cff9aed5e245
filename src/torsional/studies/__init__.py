"""Questions asked of whole models: many runs, one answer."""
