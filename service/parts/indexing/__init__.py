"""Parts of Geneva drives and ratchets."""
