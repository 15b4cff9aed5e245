"""One-sided springs as a complementarity problem, and their exact motion."""
