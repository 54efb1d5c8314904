"""The command ``mechsynth``.

Only modules needed to parse the command line are imported here: worker processes import this module again at their
start, and ``mechsynth --help`` should not take a second.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from service.jobs.processes.parent_death import bind_to_parent_at_start

if TYPE_CHECKING:
    from service.settings import Settings

bind_to_parent_at_start()

EXIT_FAILURE = 1
EXIT_USAGE = 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return the exit status: 0 success, 1 failure, 2 wrong arguments or settings."""
    # The processes of a server must not import a module `service` of the folder in which it is started.
    os.environ["PYTHONSAFEPATH"] = "1"
    command = _build_parser().parse_args(arguments)
    if command.name == "serve":
        return _serve()
    if command.name == "worker":
        return _run_worker()
    if command.name == "demo":
        from service.command.demo import DemoFailure, run_demo

        try:
            run_demo(command.output)
        except (DemoFailure, OSError) as failure:
            print(f"mechsynth demo: {failure}", file=sys.stderr)
            return EXIT_FAILURE
        return 0
    if command.name == "solve":
        from service.command.solve import SolveFailure, solve

        try:
            key = os.environ.get("MECHSYNTH_API_KEY")
            solve(command.problem, command.url, key, command.output, command.forms, as_json=command.json)
        except (SolveFailure, OSError) as failure:
            print(f"mechsynth solve: {failure}", file=sys.stderr)
            return EXIT_FAILURE
        return 0
    if command.name in ("analyze", "draw"):
        return _run_file_command(command)
    if command.name == "openapi":
        from service.server.app import build_api_document

        command.output.write_text(build_api_document(), encoding="utf-8")
        return 0
    if command.name == "keys":
        return _run_keys(command)
    if command.name in ("backup", "upgrade"):
        return _run_maintenance(command)
    return _warm()


def _warm() -> int:
    from service.api.http.documents import write_documents
    from service.server.app import build_documents
    from service.server.precompile import WarmingFailure, warm

    try:
        warm()
    except WarmingFailure as failure:
        print(f"mechsynth warm: {failure}", file=sys.stderr)
        return EXIT_FAILURE
    # Building them fills the cache folder; the documents themselves are not needed here.
    deque(write_documents(build_documents), maxlen=0)
    return 0


def _run_file_command(command: argparse.Namespace) -> int:
    from service.client import ClientError
    from service.command.inputs import SourceError

    try:
        if command.name == "draw":
            from service.command.draw import draw

            draw(command.answer, command.design, command.output)
        else:
            from service.command.analyze import analyze

            key = os.environ.get("MECHSYNTH_API_KEY")
            analyze(command.mechanism, command.url, key, command.output, as_json=command.json)
    except (SourceError, ClientError, OSError) as failure:
        print(f"mechsynth {command.name}: {failure}", file=sys.stderr)
        return EXIT_FAILURE
    return 0


def _add_service_options(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--url",
        default=os.environ.get("MECHSYNTH_URL"),
        help="URL of the service (default: MECHSYNTH_URL, or a service on this machine, or this process itself; "
        "the API key is read from MECHSYNTH_API_KEY)",
    )


def _load_settings() -> Settings | None:
    """Read the settings; if they are invalid, print the reason and return None."""
    from service.settings import SettingsError, read_settings

    try:
        return read_settings()
    except SettingsError as error:
        print(f"mechsynth: {error}", file=sys.stderr)
        return None


def _run_keys(command: argparse.Namespace) -> int:
    settings = _load_settings()
    if settings is None:
        return EXIT_USAGE
    from service.access import command as keys

    try:
        if command.act == "create":
            keys.create(settings, command.tenant, further=command.further)
        elif command.act == "list":
            keys.show(settings)
        else:
            keys.revoke(settings, command.id)
    except keys.KeysFailure as failure:
        print(f"mechsynth keys: {failure}", file=sys.stderr)
        return EXIT_FAILURE
    return 0


def _run_maintenance(command: argparse.Namespace) -> int:
    settings = _load_settings()
    if settings is None:
        return EXIT_USAGE
    from service.command.maintenance import MaintenanceFailure, back_up, run_upgrade

    try:
        if command.name == "backup":
            back_up(settings, command.file)
            return 0
        return 0 if run_upgrade(settings, only_check=command.check) else EXIT_FAILURE
    except MaintenanceFailure as failure:
        print(f"mechsynth {command.name}: {failure}", file=sys.stderr)
        return EXIT_FAILURE


def _serve() -> int:
    settings = _load_settings()
    if settings is None:
        return EXIT_USAGE
    from service.server.run import ServeError, serve

    try:
        serve(settings)
    except ServeError as error:
        print(f"mechsynth: {error}", file=sys.stderr)
        return EXIT_FAILURE
    return 0


def _run_worker() -> int:
    settings = _load_settings()
    if settings is None:
        return EXIT_USAGE
    if settings.executor != "cluster":
        print(
            "mechsynth worker: a worker host shares the database of servers; set MECHSYNTH_EXECUTOR=cluster",
            file=sys.stderr,
        )
        return EXIT_USAGE
    from sqlalchemy.exc import SQLAlchemyError

    from service.jobs.cluster.worker_host import HostError, run_host
    from service.server.precompile import Compilation, list_parts

    compilation = Compilation(list_parts, settings.log_level, settings.log_format, ahead=settings.compile_ahead)
    try:
        run_host(settings, compilation)
    except HostError as error:
        print(f"mechsynth worker: {error}", file=sys.stderr)
        return EXIT_FAILURE
    except (SQLAlchemyError, OSError) as error:
        # The message omits the URL, which may contain a password.
        print(f"mechsynth worker: cannot use the database ({type(error).__name__})", file=sys.stderr)
        return EXIT_FAILURE
    return 0


def _build_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mechsynth", description="A service that designs mechanisms.")
    commands = parser.add_subparsers(dest="name", required=True, metavar="command")
    commands.add_parser("serve", help="run the service, configured by environment variables MECHSYNTH_...")
    commands.add_parser("worker", help="run a worker host, which takes the jobs of servers from their database")
    demo = commands.add_parser("demo", help="start a service, solve an example problem and draw the answer")
    demo.add_argument("--output", type=Path, default=Path("var/demo.svg"), help="file for the drawing (SVG)")
    solve = commands.add_parser("solve", help="solve the problem in a file, print the answer and write the drawings")
    solve.add_argument(
        "problem",
        help="a JSON file with a problem or a request body; - for standard input; "
        "or a .csv with columns x, y, angle (motion), x, y (path), or input, output (function)",
    )
    _add_service_options(solve)
    solve.add_argument("--json", action="store_true", help="print the job with its answer as JSON instead of tables")
    solve.add_argument("--output", type=Path, help="folder for the drawings; by default named after the problem file")
    solve.add_argument(
        "--forms", default="svg,dxf,csv", type=lambda text: [form for form in text.split(",") if form],
        help="formats of the files to write for each design, separated by commas; '' for none",
    )  # fmt: skip
    analyze = commands.add_parser("analyze", help="analyse the mechanism in a file: angles, joints, ...")
    analyze.add_argument("mechanism", help="a JSON file with a mechanism or a request body; - for standard input")
    _add_service_options(analyze)
    analyze.add_argument("--json", action="store_true", help="print the analysis as JSON instead of tables")
    analyze.add_argument("-o", "--output", type=Path, help="output file, .json or .csv; by default tables are printed")
    draw = commands.add_parser("draw", help="draw a design of an answer, without a service")
    draw.add_argument("answer", help="output of mechsynth solve --json; - for standard input")
    draw.add_argument("-o", "--output", type=Path, required=True, help="output file: .svg, .gif, .dxf or .csv")
    draw.add_argument("--design", type=int, default=1, help="number of the design, counted from 1")
    openapi = commands.add_parser("openapi", help="write the OpenAPI document to a file")
    openapi.add_argument("output", type=Path)
    keys = commands.add_parser("keys", help="create, list and revoke API keys").add_subparsers(
        dest="act", required=True, metavar="act"
    )
    create = keys.add_parser("create", help="create a key for a new tenant and print it")
    create.add_argument("tenant", help="name of the tenant, who sees only its own jobs")
    create.add_argument("--further", action="store_true", help="create another key for an existing tenant")
    keys.add_parser("list", help="list the ids of all keys, without the keys themselves")
    keys.add_parser("revoke", help="revoke a key").add_argument("id", help="id of the key")
    backup = commands.add_parser("backup", help="copy the SQLite database of a service, which may be running")
    backup.add_argument("file", type=Path, help="a new file for the copy")
    upgrade = commands.add_parser("upgrade", help="upgrade the tables of the database; a start of the service does too")
    upgrade.add_argument("--check", action="store_true", help="change nothing; exit status 1 if it would upgrade")
    commands.add_parser("warm", help="compile the kernels and write the documents ahead of the first start")
    return parser


if __name__ == "__main__":
    sys.exit(main())
