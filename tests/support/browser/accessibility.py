"""Code that several tests share: accessibility."""

from tests.support.service.running import ROOT

AXE = ROOT / "tests" / "node" / "node_modules" / "axe-core" / "axe.min.js"

RUN = """async () => {
  const found = await axe.run(document, {resultTypes: ["violations"]});
  return {
    checked: found.passes.length,
    violations: found.violations.map(one => ({
      rule: one.id, impact: one.impact, help: one.help, where: one.nodes.slice(0, 4).map(node => node.target.join(" ")),
    })),
  };
}"""


def violations(page):
    """What axe-core finds; its rules come in by the debugger, so the page's policy stays as it is."""
    assert AXE.exists(), "make test-browser installs what this needs of node"
    if not page.evaluate("typeof axe === 'object'"):
        page.evaluate(f"{AXE.read_text()}; undefined")
    found = page.evaluate(RUN)
    assert found["checked"] > 10
    return found["violations"]
