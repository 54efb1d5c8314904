"""Every number that the page shows of an answer, read from the page: it is the answer's, with its unit.

Units and series are listed here once more, by hand: what the page has of them comes from the service.
"""

import math
import re

import pytest

SUPERS = str.maketrans("−⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "--0123456789")

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")

ANGLES = (
    "min_transmission_angle input_rotation input_travel slow_rotation fast_rotation swing steering_error outer_lock "
    "arm_angle cycle_transmission_angle unevenness max_pressure_angle_rise max_pressure_angle_fall locking_angle play "
    "peak_acceleration_angle rotation way jitter"
)
LENGTHS = (
    "size rms_distance max_distance deviation arm_length turning_radius curve_distance least_room min_convex_radius "
    "min_concave_radius wall web lift max_structural_error rms_structural_error output_range min_pin_distance "
    "max_link_width tie_rod_clearance"
)
PURE = (
    "quality link_ratio reach body_travel_ratio body_turn_ratio rms_residual time_ratio moving_links error "
    "relative_error total_teeth largest_gear largest_stage_ratio efficiency rolling_power branch_power max_error "
    "tooth_sum curvature_ratio places value gap energy_variation coefficient primary_force primary_moment "
    "secondary_force secondary_moment steady_share entry_speed relative_link_width"
)
UNITS = {
    **dict.fromkeys(ANGLES.split(), "°"),
    **dict.fromkeys(LENGTHS.split(), "mm"),
    **dict.fromkeys(PURE.split(), ""),
    **dict.fromkeys(("straightness_error", "velocity_variation"), "%"),
    **dict.fromkeys(("mean_velocity", "middle_velocity"), "mm/rad"),
    **dict.fromkeys(("residual_unbalance", "initial_unbalance"), "g·mm"),
    **dict.fromkeys(("shaking_force", "peak_pin_force"), "N"),
    **dict.fromkeys(("shaking_moment", "drive", "unbalanced_drive", "rms_drive", "unbalanced_rms_drive"), "N·m"),
    **dict.fromkeys(("peak_wheel_torque", "peak_drive_torque"), "N·m"),
    **dict.fromkeys(("least_speed", "greatest_speed"), "1/min"),
    "sum_of_squares": "mm²",
    "mass": "kg",
    "inertia": "kg·m²",
    "rim_speed": "m/s",
}
"""Of the metrics of the examples, which are in millimetres."""

UNITS_OF_KIND = {
    "cam": {
        "peak_velocity": "mm/rad",
        "peak_acceleration": "mm/rad²",
        "rms_acceleration": "mm/rad²",
        "peak_jerk": "mm/rad³",
        "peak_inertia_torque": "mm²/rad³",
    },
    "dwell": {"peak_velocity": "rad/rad", "peak_acceleration": "rad/rad²"},
    "indexing": {"peak_velocity": "rad/rad", "peak_acceleration": "rad/rad²", "peak_jerk": "rad/rad³"},
    "gearbox": {"torque": ""},
    "engine": {"torque": ""},
    "balancing": {"bound": "g·mm"},
    "spring_balancing": {"bound": ""},
}

TURNED = "angle reference_input_angle pressure_angle axis phase throws locking_angle"
COUNTED = (
    "driver driven numerator denominator value sun planet ring planets divisions steps characteristic layshaft "
    "mainshaft idler number throw place plane stations rollers"
)
DIMENSIONS = {
    **dict.fromkeys(TURNED.split(), "°"),
    **dict.fromkeys(COUNTED.split(), ""),
    "addendum": "",
    "input_speed": "1/min",
    "density": "kg/m³",
    "unbalance": "g·mm",
    "mass": "kg",
    "rate": "N/m",
    "preload": "N",
    "max_force": "N",
}
"""Of a mechanism's numbers by their names; all others are lengths."""

CURVES = {"skeleton", "profile", "pitch_curve", "program", "outer_wall"}

ROUNDING = 1e-6
"""What is called exact is no more than that, of its size."""

Extremes = list[list[float | None]]


def numbers(text):
    """The numbers of a text, with powers of ten as the page writes them."""
    plain = re.sub(r"·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", lambda one: f"e{one[1].translate(SUPERS)}", text).replace("−", "-")
    return [float(one) for one in NUMBER.findall(plain)]


def named(name):
    words = name.replace("_", " ")
    return words[:1].upper() + words[1:]


def says(text, value, unit):
    """Whether a text says a value with three digits at least, and its unit."""
    if text == "exact":
        return abs(value) <= ROUNDING
    told = numbers(text)[0]
    if told == 0.0 and 0.0 < abs(value) <= 1e-9:
        return True
    apart = "" if unit in ("", "°") else " "
    return text.endswith(f"{apart}{unit}") and told == pytest.approx(value, rel=5.1e-3, abs=1e-12)


def rows(page, heading):
    """Name, text and title of the rows of a table by its heading."""
    section = page.locator("#numbers section", has=page.locator("h4", has_text=re.compile(f"^{heading}$")))
    return section.locator("tr").evaluate_all(
        "all => all.map(row => [row.querySelector('th').textContent, row.querySelector('td').textContent, "
        "row.querySelector('td').title])"
    )


def unit_of(kind, name):
    return UNITS_OF_KIND.get(kind, {}).get(name, UNITS.get(name))


def metrics_are_the_answers(page, kind, designs):
    shown = {name: (text, title) for name, text, title in rows(page, "Quantities")}
    for name, value in designs[0]["metrics"].items():
        if isinstance(value, bool) or not isinstance(value, int | float):
            continue
        unit = unit_of(kind, name)
        assert unit is not None, f"{kind}: no unit is listed for {name}"
        text, title = shown[named(name)]
        assert says(text, value, unit), (name, text, value, unit)
        assert numbers(title)[0] == pytest.approx(value, rel=1e-12, abs=1e-9)
        assert title.endswith(unit)
    cards = page.locator(".card").evaluate_all(
        "all => all.map(one => [one.querySelector('strong').textContent, "
        "...[...one.querySelectorAll('.figure span')].map(part => part.textContent)])"
    )
    assert len(cards) == len(designs)
    for n, (design, (heading, name, text)) in enumerate(zip(designs, cards, strict=True), 1):
        assert heading.startswith(f"{n}. ")
        key = name.lower().replace(" ", "_")
        assert says(text, design["metrics"][key], unit_of(kind, key)), (n, name, text)


def checks_are_the_answers(page, design):
    listed = page.locator("#numbers .checks li").evaluate_all(
        "all => all.map(one => [one.querySelector('.note')?.textContent ?? '', one.querySelector('.note')?.title])"
    )
    told = design["verification"]["checks"]
    assert len(listed) == len(told)
    units = {None: "", "angle": "°", "length": "mm", "output": "°"}
    for check, (text, title) in zip(told, listed, strict=True):
        if isinstance(check.get("value"), bool) or not isinstance(check.get("value"), int | float):
            assert not numbers(text), check
            continue
        unit = units[check.get("dimension")]
        pair = [check["value"], *([check["limit"]] if isinstance(check.get("limit"), int | float) else [])]
        assert numbers(title) == pytest.approx(pair, rel=1e-12, abs=1e-15), check
        for part, value in zip(text.strip().split(", limit "), pair, strict=False):
            assert says(part, value, unit), (check, text)


def sizes(name, value):
    """Names and numbers of a mechanism, as deep as a table goes."""
    if isinstance(value, dict):
        return [one for key, inner in value.items() for one in sizes(name if name == "addendum" else key, inner)]
    if isinstance(value, list):
        if 0 < len(value) <= 4 and all(isinstance(one, int | float) for one in value):
            return [(name, value)]
        if len(value) <= 8 and all(isinstance(one, dict) for one in value):
            return [one for inner in value for one in sizes(name, inner)]
        return []
    if isinstance(value, bool) or not isinstance(value, int | float):
        return []
    return [(name, [value])]


def dimensions_are_the_answers(page, design):
    listed = [one for one in rows(page, "Dimensions") if numbers(one[2])]
    springs = [{k: v for k, v in one.items() if k != "number"} for one in design.get("springs") or []]
    own = {name: one for name, one in design["mechanism"].items() if name not in {"type", *CURVES}}
    wanted = [*sizes("", springs), *sizes("", own)]
    assert len(listed) == len(wanted)
    for (label, text, title), (name, values) in zip(listed, wanted, strict=True):
        unit = DIMENSIONS.get(name, "mm")
        assert numbers(text.removesuffix(unit)) == pytest.approx(values, rel=6e-5, abs=1e-12), (label, name)
        told = numbers(title.removesuffix(unit))
        assert told == pytest.approx(values, rel=1e-12, abs=1e-12), (label, name)
        assert text.endswith(unit), (label, name, text)
        assert unit or re.search(r"[\d]$", text.translate(SUPERS)), (label, text)


def total(*parts):
    return [None if None in both else math.hypot(*both) for both in zip(*parts, strict=True)]


def series_of(title, motion, design, sliding):
    """What a plot shows, by its title."""
    joints, links, slides = (motion.get(name) or {} for name in ("joints", "links", "slides"))
    course, program = design.get("course"), design["mechanism"].get("program")
    plain = {
        "Transmission angle (°)": lambda: [motion["transmission_angle"]],
        "Pressure angle (°)": lambda: [motion["pressure_angle"]],
        "Displacement s (mm)": lambda: [program["s"]],
        "Jerk j (mm/rad³)": lambda: [program["j"]],
        "Velocity v (mm/rad)": lambda: [program["v"]],
        "Acceleration a (mm/rad²)": lambda: [program["a"]],
        "Structural error (mm)": lambda: [design["structural_error"]["curve"]["error"]],
        "Steering error (°)": lambda: [[one["error"] for one in design["targets"]]],
        "Speed (1/min)": lambda: [course["speed"]],
        "Torque (N·m)": lambda: [course["torque"]],
        "Wheel turned (°)": lambda: [motion["angle"]],
        "Velocity v (rad/rad)": lambda: [motion["omega"]],
        "Acceleration a (rad/rad²)": lambda: [motion["alpha"]],
        "Piston 1 above the crank (mm)": lambda: [motion["cylinders"][0]["place"]],
        "Velocity of piston 1 (mm/rad)": lambda: [motion["cylinders"][0]["velocity"]],
        "Acceleration of piston 1 (mm/rad²)": lambda: [motion["cylinders"][0]["acceleration"]],
        "Force on the bearings at 1 rad/s, along x (N)": lambda: [one["force"]["x"] for one in motion["bearings"]],
    }
    if title in plain:
        return plain[title]()
    what, name, unit = re.fullmatch(r"(.+) of (\w+)(?: on its line)? \((.+)\)", title).groups()
    wanted_unit, point, slide, link = {
        "Position": ("mm", ("x", "y"), "position", None),
        "Velocity": ("mm/rad", ("vx", "vy"), "velocity", None),
        "Acceleration": ("mm/rad²", ("ax", "ay"), "acceleration", None),
        "Angle": ("°", None, None, "angle"),
        "Angular velocity": ("rad/rad", None, None, "omega"),
        "Angular acceleration": ("rad/rad²", None, None, "alpha"),
    }[what]
    assert unit == wanted_unit, title
    if link:
        return [links[name][link]]
    if sliding:
        return [slides[name][slide]]
    pair = [joints[name][axis] for axis in point]
    return pair if what == "Position" else [total(*pair), *pair]


def plots_are_the_motions(page, motion, design):
    page.click("#tab-plots")
    sliding = page.locator("#part").count() == 1 and page.input_value("#part").startswith("slide ")
    labels = page.locator("#plots .plot svg[role=img]").evaluate_all("all => all.map(one => one.ariaLabel)")
    for label in labels:
        title, low, high = re.fullmatch(r"(.*): from (\S+) to (\S+)", label).groups()
        known = [one for line in series_of(title, motion, design, sliding) for one in line if one is not None]
        least, most = min(known), max(known)
        told = [numbers(low)[0], numbers(high)[0]]
        assert told == pytest.approx([least, most], rel=1e-4, abs=1e-6 * (most - least) + 1e-12), label
    page.click("#tab-numbers")
    return labels


def gauge_is_the_answers(page, motion, design):
    if page.locator(".gauge").count() == 0:
        return
    if "links" not in motion:
        wanted = max(one for one in motion["pressure_angle"] if one is not None)
    elif "min_transmission_angle" in design["metrics"] and len(design.get("targets", [0, 0])) > 1:
        # What is used may be a part of the whole motion.
        wanted = design["metrics"]["min_transmission_angle"]
    else:
        wanted = motion["min_transmission_angle"]
    text = page.locator(".gauge svg text", has_text=re.compile("minimum|maximum")).text_content()
    assert text.endswith("°")
    assert numbers(text)[0] == pytest.approx(wanted, abs=0.051), text


def explorer_is_the_designs(page, design):
    """Its dimensions are distances and angles between the joints of the design."""
    page.click("#tab-explore")
    page.locator(".sizes-of input[type=number]").first.wait_for()
    joints = {name: complex(*at) for name, at in design["mechanism"]["skeleton"]["joints"].items()}
    found = page.locator(".sizes-of tbody tr").evaluate_all(
        "all => all.map(row => [row.querySelector('th').textContent, row.querySelector('input').valueAsNumber])"
    )
    for label, value in found:
        length = re.search(r"(\w+)–(\w+) \(mm\)$", label)
        if length:
            wanted = abs(joints[length[1]] - joints[length[2]])
        else:
            names = re.search(r"∠(.+) \(°\)$", label)[1]
            at = next(
                (a, b, c) for a in joints for b in joints for c in joints if f"{a}{b}{c}" == names
            )  # fmt: skip
            turn = (joints[at[2]] - joints[at[1]]) / (joints[at[0]] - joints[at[1]])
            wanted = math.degrees(math.atan2(turn.imag, turn.real))
        assert value == pytest.approx(wanted, rel=2e-5, abs=1e-6), label
    page.click("#tab-numbers")
    return found


def speeds_are_the_motions(page, motion):
    told = page.locator(".speeds dd").all_inner_texts()
    if not told or not told[0].endswith("× input"):
        return
    named_shafts = [one for one in motion.get("shafts") or [] if one.get("name")]
    if motion.get("bodies"):
        wanted = [one["speed"] for one in motion["bodies"]]
    elif motion.get("units") or named_shafts:
        wanted = [one["speed_ratio"] for one in motion["shafts"]]
    else:
        wanted = [one["speed_ratio"] for one in motion["gears"]]
    for text, value in zip(told, wanted, strict=True):
        if value == 0.0:
            assert text == "held"
        else:
            assert text.endswith(" × input")
            assert numbers(text)[0] == pytest.approx(value, rel=1e-4)


def told_as_answered(page, kind):
    """Compare all that is told of the first design with its answer and its motion."""
    job = page.evaluate("location.hash.slice(5)")
    result = page.evaluate("id => fetch(`/v1/jobs/${id}`).then(answer => answer.json())", job)["result"]
    design = result["designs"][0]
    linkage = "skeleton" in design["mechanism"]
    steps = 240 if linkage else 360
    motion = page.evaluate(
        "([id, steps]) => fetch(`/v1/jobs/${id}/designs/0/motion?steps=${steps}`).then(answer => answer.json())",
        [job, steps],
    )
    metrics_are_the_answers(page, kind, result["designs"])
    checks_are_the_answers(page, design)
    dimensions_are_the_answers(page, design)
    gauge_is_the_answers(page, motion, design)
    speeds_are_the_motions(page, motion)
    plotted = plots_are_the_motions(page, motion, design)
    even = kind in ("gear_train", "planetary_train", "train_series", "gearbox", "layshaft_gearbox")
    assert bool(plotted) != even, "what turns evenly has no plots, all else has"
    if linkage:
        assert explorer_is_the_designs(page, design)
