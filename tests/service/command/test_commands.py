"""``mechsynth solve --json`` and its tables, ``mechsynth analyze`` and ``mechsynth draw``, against a real server."""

import csv
import io
import json
import socket
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


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as place:
        return place.getsockname()[1]


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
        patch.delenv("MECHSYNTH_URL", raising=False)
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
            # Decimal commas, a unit, comments, and a curve that returns to its start.
            "# scan\nx [cm];y [cm];tolerance [cm]\n0,5;0;0,1\n1;2,25;0,1 # top\n\n3;1;0,1\n2;-1;0,2\n0,5;0;0,1\n",
            {
                "kind": "path",
                "length_unit": "cm",
                "closed": True,
                "points": [
                    {"x": 0.5, "y": 0, "tolerance": 0.1},
                    {"x": 1, "y": 2.25, "tolerance": 0.1},
                    {"x": 3, "y": 1, "tolerance": 0.1},
                    {"x": 2, "y": -1, "tolerance": 0.2},
                ],
            },
        ),
        (
            "x [in],y [in],angle [°]\n0,0,0\n1,2,-30\n",
            {
                "kind": "motion",
                "length_unit": "in",
                "positions": [{"x": 0, "y": 0, "angle": 0}, {"x": 1, "y": 2, "angle": -30}],
            },
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
        ("x,y\n1,2,3\n", "line 2: more cells than columns"),
        ("# from a scan\nx,y\n1,2\n1,2,3\n", "line 4: more cells than columns"),
        ("x [mm],y [in]\n1,2\n", "the columns have different units: in, mm"),
        ("x [furlong],y [furlong]\n1,2\n", "unknown length unit furlong; known: mm"),
        ("x [mm],y [mm],angle [rad]\n1,2,0\n", "angle is in rad; angles are in degrees"),
        ("x;y\n1,2,3;4\n", "line 2: x is not a number: 1.2,3"),
        ("x,y\n1,2\n3,north\n", "line 3: y is not a number: north"),
        ("x,y\n1,NaN\n", "line 2: y is not a number: NaN"),
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
    done = mechsynth(tmp_path, "analyze", "-", "--url", server.url, "--json", stdin=json.dumps(body))
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


def test_an_analysis_is_printed_as_tables(monkeypatch, tmp_path):
    """Least and greatest values with their inputs, by a process of its own: no service runs at this address."""
    monkeypatch.setattr("service.command.local.DEFAULT_URL", f"http://127.0.0.1:{free_port()}")
    body = {"mechanism": FOURBAR, "motion": {"from": 30, "to": 90, "steps": 4}}
    done = mechsynth(tmp_path, "analyze", "-", stdin=json.dumps(body))
    assert done.returncode == 0, done.stderr
    assert "this process computes the answer" in done.stderr
    answer = json.loads(mechsynth(tmp_path, "analyze", "-", "--json", stdin=json.dumps(body)).stdout)
    angles = answer["transmission_angles"]["coupler"]
    (row,) = (line for line in done.stdout.splitlines() if "transmission_angles.coupler" in line)
    printed = [float(cell) for cell in row.replace("│", " ").split()[1:]]
    least, greatest = (angles.index(extreme(angles)) for extreme in (min, max))
    expected = [angles[least], answer["input_angle"][least], angles[greatest], answer["input_angle"][greatest]]
    assert printed == pytest.approx(expected, rel=1e-5)
    assert "Over 5 positions of the input" in done.stdout


def test_a_problem_is_solved_without_a_service(monkeypatch, tmp_path):
    monkeypatch.setattr("service.command.local.DEFAULT_URL", f"http://127.0.0.1:{free_port()}")
    (tmp_path / "train.json").write_text(json.dumps(TRAIN))
    done = mechsynth(tmp_path, "solve", "train.json", "--json", "--forms", "svg,csv")
    assert done.returncode == 0, done.stderr
    assert "no service at" in done.stderr
    job = json.loads(done.stdout)
    assert (job["status"], job["label"], len(job["result"]["designs"])) == ("succeeded", "train", 2)
    assert job["problem"]["pressure_angle"] == 20.0
    written = {file.name for file in (tmp_path / "train-designs").iterdir()}
    assert written == {"design-1.svg", "design-1.csv", "design-2.svg", "design-2.csv"}
    # The answer can be drawn again like that of a service.
    (tmp_path / "answer.json").write_text(done.stdout)
    drawn = mechsynth(tmp_path, "draw", "answer.json", "-o", "again.svg")
    assert drawn.returncode == 0, drawn.stderr
    assert (tmp_path / "again.svg").read_bytes() == (tmp_path / "train-designs" / "design-1.svg").read_bytes()


@pytest.mark.parametrize(
    ("command", "content", "says"),
    [
        ("solve", {"kind": "gear_trane", "ratio": 2}, "/problem/kind"),
        ("solve", {**TRAIN, "ratio": -2.5, "max_stage": 2}, "/problem/max_stage"),
        ("solve", {**TRAIN, "module": 1.0, "diametral_pitch": 8.0}, "/problem/diametral_pitch"),
        ("analyze", {**FOURBAR, "links": {"input": 2.0}}, "/mechanism/links/coupler"),
        ("analyze", {"type": "fivebaar"}, "/mechanism/type"),
    ],
)
def test_without_a_service_faults_have_their_places(monkeypatch, tmp_path, command, content, says):
    monkeypatch.setattr("service.command.local.DEFAULT_URL", f"http://127.0.0.1:{free_port()}")
    done = mechsynth(tmp_path, command, "-", stdin=json.dumps(content))
    assert done.returncode == 1
    assert says in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("{", "not JSON"),
        ("[]", "no JSON object"),
        ('{"mechanism": 3}', "contains no mechanism"),
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
        (("answer.json", "-o", "a.svg", "--design", "3"), "design 3 does not exist"),
        (("answer.json", "-o", "a.svg", "--design", "0"), "design 0 does not exist"),
        (("train.json", "-o", "a.svg"), "mechsynth solve --json writes one"),
        (("other.json", "-o", "a.svg"), "no answer of this version"),
        (("rotor.json", "-o", "a.gif"), "available: svg, dxf, csv"),
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
