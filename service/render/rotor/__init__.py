"""Files of balanced rotors: the sheet, a template for drilling, and a table."""
