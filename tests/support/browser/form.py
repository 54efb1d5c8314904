"""Code that several tests share: form."""

OPEN_ALL = """() => {
  for (let rounds = 0; rounds < 8; rounds++) {
    for (const one of document.querySelectorAll("#fields details")) one.dispatchEvent(new Event("reveal"));
  }
}"""
