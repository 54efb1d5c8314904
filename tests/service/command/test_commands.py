"""``mechsynth solve --json`` and its tables, ``mechsynth analyze`` and ``mechsynth draw``, against a real server."""

import csv
import io
import json
import sys
from contextlib import redirect_stderr, redirect_stdout
from typing import NamedTuple

import pytest

from service.command.cli import main
from service.command.inputs import read_problem
from synthesis.registry import parse_problem

TRAIN = {"kind": "gear_train", "ratio": "7/3", "max_stages": 1, "max_designs": 2}
FOURBAR = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
}


class Done(NamedTuple):
    """What a command has said; it is run in this process, which takes a tenth of the time."""

    returncode: int
    stdout: str
    stderr: str


def mechsynth(folder, *arguments, stdin=""):
    out, err = io.StringIO(), io.StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out), redirect_stderr(err):
        patch.chdir(folder)
        patch.setattr(sys, "stdin", io.StringIO(stdin))
        patch.delenv("MECHSYNTH_API_KEY", raising=False)
        return Done(main(arguments), out.getvalue(), err.getvalue())


@pytest.fixture(scope="module")
def solved(server, tmp_path_factory):
    """A folder with an answer that the command has printed."""
    folder = tmp_path_factory.mktemp("solved")
    (folder / "train.json").write_text(json.dumps(TRAIN))
    done = mechsynth(folder, "solve", "train.json", "--url", server.url, "--json", "--forms", "csv")
    assert done.returncode == 0, done.stderr
    assert "train-designs" in done.stderr
    (folder / "answer.json").write_text(done.stdout)
    return folder


def test_an_answer_is_printed_as_json_in_full(server, solved):
    job = json.loads((solved / "answer.json").read_text())
    shown = server.job(job["id"])
    assert {name: shown[name] for name in job} == job
    assert (job["status"], job["label"], len(job["result"]["designs"])) == ("succeeded", "train", 2)


def test_nothing_of_a_table_is_cut_in_a_file(server, tmp_path):
    (tmp_path / "task.json").write_text(json.dumps({**TRAIN, "max_designs": 1}))
    done = mechsynth(tmp_path, "solve", "task.json", "--url", server.url, "--forms", "")
    assert done.returncode == 0, done.stderr
    design = server.job(server.client.get("/v1/jobs?limit=1").json()["jobs"][0]["id"])["result"]["designs"][0]
    assert "…" not in done.stdout
    heads = next(line for line in done.stdout.splitlines() if "mechanism" in line)
    plain = [name for name, value in design["metrics"].items() if isinstance(value, int | float | str)]
    assert all(name.replace("_", " ") in heads for name in plain[:7])


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (
            "x,y,angle\n0,0,0\n10.25,5,30\n",
            {"kind": "motion", "positions": [{"x": 0, "y": 0, "angle": 0}, {"x": 10.25, "y": 5, "angle": 30}]},
        ),
        (
            "angle; x; y; tolerance; exact\n0; 0; 0;; true\n30; 1e1; 5; 0.5;\n\n",
            {
                "kind": "motion",
                "positions": [
                    {"angle": 0, "x": 0, "y": 0, "exact": True},
                    {"angle": 30, "x": 10.0, "y": 5, "tolerance": 0.5},
                ],
            },
        ),
        (
            "\ufeffx\ty\r\n0\t0\r\n1\t2\r\n3\t1\r\n",
            {"kind": "path", "points": [{"x": 0, "y": 0}, {"x": 1, "y": 2}, {"x": 3, "y": 1}]},
        ),
        (
            "input,output\n0,0\n30,12\n60,40\n",
            {
                "kind": "function",
                "pairs": [{"input": 0, "output": 0}, {"input": 30, "output": 12}, {"input": 60, "output": 40}],
            },
        ),
    ],
)  # fmt: skip
def test_a_table_states_a_problem(tmp_path, table, expected):
    place = tmp_path / "task.csv"
    place.write_bytes(table.encode())
    problem, label = read_problem(str(place))
    assert label == "task"
    assert problem == expected
    assert parse_problem(problem).kind == expected["kind"]


def test_a_table_is_solved(server, tmp_path):
    (tmp_path / "places.csv").write_text("x,y,angle\n0,0,0\n10.25,5,30\n")
    done = mechsynth(tmp_path, "solve", "places.csv", "--url", server.url, "--json", "--forms", "")
    assert done.returncode == 0, done.stderr
    problem = json.loads(done.stdout)["problem"]
    assert [(at["x"], at["y"], at["angle"]) for at in problem["positions"]] == [(0.0, 0.0, 0.0), (10.25, 5.0, 30.0)]


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("a,b\n1,2\n", "the first line must name the columns"),
        ("", "the first line must name the columns"),
        ("x,y\n1,2,3\n", "line 2: there are more cells than columns"),
        ("x,y\n1,2\n3,north\n", "line 3: y is no number: north"),
        ("x,y\n1,NaN\n", "line 2: y is no number: NaN"),
        ("x,y,colour\n1,2,3\n4,5,6\n7,1,2\n", "/problem/points/0/colour"),
    ],
)
def test_what_is_wrong_with_a_table_is_said(server, tmp_path, table, says):
    (tmp_path / "task.csv").write_text(table)
    done = mechsynth(tmp_path, "solve", "task.csv", "--url", server.url)
    assert done.returncode == 1
    assert says in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("body", [FOURBAR, {"mechanism": FOURBAR, "motion": {"from": 30, "to": 90, "steps": 4}}])
def test_a_mechanism_is_analysed(server, tmp_path, body):
    request = body if "mechanism" in body else {"mechanism": body}
    done = mechsynth(tmp_path, "analyze", "-", "--url", server.url, stdin=json.dumps(body))
    assert done.returncode == 0, done.stderr
    expected = server.client.post("/v1/analyses", json=request).json()
    assert json.loads(done.stdout) == expected
    (tmp_path / "mechanism.json").write_text(json.dumps(body))
    done = mechsynth(tmp_path, "analyze", "mechanism.json", "--url", server.url, "-o", "tables/motion.csv")
    assert done.returncode == 0, done.stderr
    with (tmp_path / "tables" / "motion.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["input_angle"]) for row in rows] == expected["input_angle"]
    assert [float(row["joints.B.vx"]) for row in rows] == expected["joints"]["B"]["vx"]
    assert [float(row["transmission_angles.coupler"]) for row in rows] == expected["transmission_angles"]["coupler"]


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("{", "not JSON"),
        ("[]", "no JSON object"),
        ('{"mechanism": 3}', "holds no mechanism"),
        (json.dumps({**FOURBAR, "links": {"input": 2.0}}), "/mechanism/links/coupler"),
        (None, "cannot read"),
    ],
)
def test_what_cannot_be_analysed_is_said(server, tmp_path, content, says):
    if content is not None:
        (tmp_path / "mechanism.json").write_text(content)
    done = mechsynth(tmp_path, "analyze", "mechanism.json", "--url", server.url)
    assert done.returncode == 1
    assert says in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("number", [0, 1])
def test_a_design_is_drawn_as_the_service_draws_it(server, solved, number):
    job = json.loads((solved / "answer.json").read_text())
    for form in ("svg", "csv"):
        place = f"drawn/{number}.{form}"
        done = mechsynth(solved, "draw", "answer.json", "--design", str(number + 1), "-o", place)
        assert done.returncode == 0, done.stderr
        drawn = (solved / place).read_bytes()
        assert drawn == server.client.get(f"/v1/jobs/{job['id']}/designs/{number}.{form}").content


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("answer.json", "-o", "a.png"), "must end in one of: .svg, .gif, .dxf, .csv"),
        (("answer.json", "-o", "a.svg", "--design", "3"), "3 is none of them"),
        (("answer.json", "-o", "a.svg", "--design", "0"), "counted from 1; 0 is none of them"),
        (("train.json", "-o", "a.svg"), "mechsynth solve --json writes one"),
        (("other.json", "-o", "a.svg"), "no answer of this version"),
        (("rotor.json", "-o", "a.gif"), "there are: svg, dxf, csv"),
        (("nowhere.json", "-o", "a.svg"), "cannot read"),
    ],
)
def test_what_cannot_be_drawn_is_said(server, solved, arguments, says):
    job = json.loads((solved / "answer.json").read_text())
    (solved / "other.json").write_text(json.dumps({**job, "result": {"designs": []}}))
    if arguments[0] == "rotor.json" and not (solved / "rotor.json").exists():
        examples = {each["kind"]: each["example"] for each in server.client.get("/v1/problems").json()["problems"]}
        answer = server.post(problem=examples["flywheel"], wait=30)
        (solved / "rotor.json").write_text(json.dumps(answer))
    done = mechsynth(solved, "draw", *arguments)
    assert done.returncode == 1
    assert says in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(solved.glob("a.*"))
