"""A Python script that simulates a machine in MuJoCo and compares its joint angles with those of the analysis."""

from __future__ import annotations

import json
from collections.abc import Iterator

from service.simulation.mjcf import count_steps, write_mjcf
from service.simulation.model import Multibody
from service.simulation.naming import join_lines

PROGRAM = '''

def simulated():
    """Run the motion; yield the time, the joint coordinates and the drive at each row of MOTION."""
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    addresses = [model.joint(joint).qposadr[0] for joint in JOINTS]
    drive = model.equality("drive").id
    for row in range(len(MOTION)):
        mujoco.mj_forward(model, data)
        rows = [n for n in range(data.nefc) if data.efc_type[n] == EQUALITY and data.efc_id[n] == drive]
        yield data.time, [float(data.qpos[address]) for address in addresses], float(data.efc_force[rows[0]])
        if row + 1 < len(MOTION):
            mujoco.mj_step(model, data, STEPS)


def difference(one, other):
    """Return the distance of two numbers; infinity if one is NaN."""
    between = abs(one - other)
    return between if between == between else float("inf")


def run(path):
    """Compare the motion, write it to the table ``path`` if given, and return the largest difference."""
    worst, peak, table = [0.0] * len(JOINTS), 0.0, []
    for expected, (time, found, force) in zip(MOTION, simulated(), strict=True):
        worst = [max(most, difference(one, other)) for most, one, other in zip(worst, found, expected, strict=True)]
        peak = max(peak, abs(force))
        table.append([time, *found, force])
    if path:
        with open(path, "w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["time s", *(f"{joint} {unit}" for joint, unit in zip(JOINTS, UNITS)), f"drive {FORCE}"])
            rows.writerows(table)
    print("largest difference from the analysis:")
    for joint, unit, most, far in zip(JOINTS, UNITS, worst, FARTHEST):
        print(f"  {joint}: {most:.2e} {unit} of at most {far:.4g} {unit}")
    print(f"greatest drive: {peak:.6g} {FORCE}")
    return max(most if unit == "rad" else most / SIZE for most, unit in zip(worst, UNITS))


def view():
    """Show the motion in a loop."""
    import mujoco.viewer

    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    with mujoco.viewer.launch_passive(model, data) as window:
        while window.is_running():
            begun = clock.time()
            mujoco.mj_step(model, data, max(1, round(0.02 / model.opt.timestep)))
            if data.time >= DURATION:
                mujoco.mj_resetDataKeyframe(model, data, 0)
            window.sync()
            # Show fifty frames a second, in real time.
            clock.sleep(max(0.0, 0.02 - (clock.time() - begun)))


def main():
    """Run or show the motion; return 1 if joints deviate from the analysis by more than the tolerance."""
    parser = argparse.ArgumentParser(description=TITLE.replace("%", "%%"))
    parser.add_argument("--view", action="store_true", help="show the motion in MuJoCo's viewer")
    parser.add_argument("--csv", help="write the motion and the drive to this file")
    parser.add_argument("--tolerance", type=float, default=1e-4, help="radians, or shares of the size (1e-4)")
    # A title may contain letters that the console cannot print.
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")
    options = parser.parse_args()
    print(TITLE)
    for remark in REMARKS:
        print(remark)
    if options.view:
        view()
        return 0
    return 0 if run(options.csv) <= options.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
'''


def write_script(machine: Multibody) -> str:
    """Write the script as text; it needs only the package ``mujoco``."""
    return "\n".join(_write_head(machine)) + PROGRAM


def _write_head(machine: Multibody) -> Iterator[str]:
    hinge = machine.by_name[machine.driven].sort == "hinge"
    yield "#!/usr/bin/env python3"
    yield '"""Runs a machine in MuJoCo: pip install mujoco. SI units: metres, kilograms, radians, seconds."""'
    yield ""
    yield "import argparse"
    yield "import csv"
    yield "import sys"
    yield "import time as clock"
    yield ""
    yield "import mujoco"
    yield ""
    yield f"TITLE = {_format_text(machine.title)}"
    yield f"REMARKS = [{', '.join(_format_text(remark) for remark in machine.remarks)}]"
    yield f"DURATION = {machine.duration!r}"
    yield f"SIZE = {machine.size!r}"
    yield f'FORCE = "{"N m" if hinge else "N"}"'
    yield f"STEPS = {count_steps(machine)}  # between two rows of MOTION"
    yield "EQUALITY = mujoco.mjtConstraint.mjCNSTR_EQUALITY"
    yield f"JOINTS = {json.dumps([body.joint for body in machine.bodies])}"
    yield f"UNITS = {json.dumps([body.unit for body in machine.bodies])}"
    farthest = [max(abs(float(q)) for q in machine.motion[body.name]) for body in machine.bodies]
    yield f"FARTHEST = [{', '.join(f'{far:.9g}' for far in farthest)}]"
    yield ""
    yield "# The model, identical to the .mjcf file."
    yield "MODEL = ("
    # ASCII literals keep the script independent of the platform's encoding.
    for line in write_mjcf(machine).splitlines():
        yield f"    {line + chr(10)!a}"
    yield ")"
    yield ""
    yield "# Joint coordinates from the analysis, evenly spaced over the motion."
    yield "MOTION = ["
    for row in zip(*(machine.motion[body.name] for body in machine.bodies), strict=True):
        yield f"    [{', '.join(f'{float(q):.12g}' for q in row)}],"
    yield "]"


def _format_text(text: str) -> str:
    """Return text as an ASCII Python literal."""
    return ascii(join_lines(text))
