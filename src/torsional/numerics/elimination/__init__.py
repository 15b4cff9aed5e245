"""Linear response by elimination, one topology for any number of designs and frequencies."""
