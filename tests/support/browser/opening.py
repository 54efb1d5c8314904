"""Code that several tests share: opening."""

FIRST_S = 1.5
"""Until the first machine moves, on a server that has served the page before."""

MOVES = """() => {
  const link = document.querySelector(".moving .live .link")?.getAttribute("d");
  window.firstLink ??= link;
  return link && link !== window.firstLink ? performance.now() / 1000 : 0;
}"""
