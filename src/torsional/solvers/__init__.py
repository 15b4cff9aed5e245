"""Analyses: one a file, each with one public function."""
