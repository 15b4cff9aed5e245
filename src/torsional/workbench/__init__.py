"""The workbench: a local page on which a model answers while its values are turned."""
