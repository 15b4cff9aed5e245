"""Linear equations and their relatives: small and sparse systems, null spaces, exponentials."""
