"""Pure mathematics: no mechanics here."""
