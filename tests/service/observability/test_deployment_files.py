"""The alerts and the board for operators ask for metrics and values that the service has."""

import json
import re
from pathlib import Path

import yaml

from service.api.pages.problem_types import PROBLEM_TYPES
from service.observability.metrics import HostMetrics, Metrics
from service.observability.store_figures import StoreFigures

FOLDER = Path(__file__).parents[3] / "docs" / "operations" / "deploy"
ALERTS = yaml.safe_load((FOLDER / "alerts.yml").read_text("utf-8"))["groups"][0]["rules"]
PANELS = json.loads((FOLDER / "grafana.json").read_text("utf-8"))["panels"]
EXPRESSIONS = [rule["expr"] for rule in ALERTS] + [target["expr"] for panel in PANELS for target in panel["targets"]]


def known_names():
    server, host = Metrics(), HostMetrics()
    server.watch(lambda: 0, lambda: 0, lambda: StoreFigures({}, 0.0, 0, 0))
    server.watch_calls(dict)
    families = [family for metrics in (server, host) for family in metrics.registry.collect()]
    suffixes = {"counter": ("_total",), "histogram": ("_bucket", "_sum", "_count")}
    return {f"{family.name}{suffix}" for family in families for suffix in suffixes.get(family.type, ("",))}


def test_every_metric_that_is_asked_for_exists():
    asked = {name for text in EXPRESSIONS for name in re.findall(r"\b(?:mechsynth|process)_\w+", text)}
    assert len(asked) > 15
    assert asked <= known_names()


def test_every_reason_of_a_refusal_exists():
    reasons = {reason for text in EXPRESSIONS for reason in re.findall(r'rejections_total\{reason="([^"]+)"', text)}
    assert reasons
    assert reasons <= PROBLEM_TYPES.keys()


def test_every_alert_says_what_is_wrong():
    names = [rule["alert"] for rule in ALERTS]
    assert len(set(names)) == len(names)
    assert all(rule["annotations"]["summary"].endswith(".") for rule in ALERTS)
    assert {rule["labels"]["severity"] for rule in ALERTS} == {"critical", "warning"}


def test_compose_and_prometheus_find_the_files():
    prometheus = yaml.safe_load((FOLDER / "prometheus.yml").read_text("utf-8"))
    compose = yaml.safe_load((FOLDER / "compose.yaml").read_text("utf-8"))
    mounted = [volume.split(":")[:2] for volume in compose["services"]["prometheus"]["volumes"]]
    assert set(prometheus["rule_files"]) <= {target for _, target in mounted}
    assert all((FOLDER / source).is_file() for source, _ in mounted)
