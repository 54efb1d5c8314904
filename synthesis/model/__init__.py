"""What every statement and every answer is made of, whatever the kind."""
