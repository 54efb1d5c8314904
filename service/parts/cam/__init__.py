"""Parts of cam mechanisms: radial cams, barrel cams and their followers."""
