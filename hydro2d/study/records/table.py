"""The table of cases: one row of values in SI for each case, as CSV, and the columns shown on the page."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from hydro2d.base.formats import cell
from hydro2d.measure.outcome import ratio
from hydro2d.measure.result import unit
from hydro2d.measure.summary import Conservation, Summary
from hydro2d.study.records.experiments import Measurement
from hydro2d.study.records.record import Record
from hydro2d.study.records.responses import DEPTH, RESIDUAL, Choice, is_velocity, raw, response
from hydro2d.study.records.study_directory import DONE, Axis, Study

#: largest number of sinks named on the page, and the smallest fraction of the start energy of one that is named
NAMED_SINKS, SMALLEST_SHARE = 3, 1e-6

#: numbers of a run with a median and a spread in an ensemble; all but the ratios are names of summary.json
LENGTH_RATIO, RADIUS_RATIO = "rod_length_ratio", "rod_radius_ratio"
RESULTS = (DEPTH, "rod_length_m", LENGTH_RATIO, "rod_max_radius_m", RADIUS_RATIO, "rod_tail_velocity_m_s", "rod_mass_kg",
           RESIDUAL)

Row = dict[str, object]


def rows(study: Study, records: Sequence[Record], measurements: dict[str, Measurement]) -> list[Row]:
    """One row for each case, with values by name and unit; None for missing values. ``measurements`` by case."""
    all_rows = [_row(study, record, measurements.get(record.case.name)) for record in records]
    names = list(dict.fromkeys(name for row in all_rows for name in row))
    return [{name: row.get(name) for name in names} for row in all_rows]


def _row(study: Study, record: Record, measurement: Measurement | None) -> Row:
    case, setup = record.case, record.setup
    row: Row = {"status": case.status, "message": case.message, "unfinished": record.unfinished,
                "velocity_m_s": record.velocity}
    what = (setup.shape, setup.rod, setup.target, setup.nose, setup.thickness) if setup else (None,) * 5
    row |= zip(("projectile", "rod", "target", "nose", "target_thickness_m"), what, strict=True)
    row |= _results(record) | _compared(record, measurement) | _audit(case.summary) | _cost(record)
    axes = {_name_of(axis, row): case.values.get(axis.name) for axis in study.axes}
    return {"case": case.name, **axes, **_member(study, record), **row}


def _member(study: Study, record: Record) -> Row:
    """In an ensemble, the case that a run repeats, its number, the seed and the changes; None for any other run."""
    case = record.case
    changed = {name: case.changed.get(name) for each in study.ensembles for name in each.by}
    if case.ensemble is None:
        return dict.fromkeys(("ensemble", "member", "seed", *changed)) if study.ensembles else {}
    return {"ensemble": case.of, "member": case.member, "seed": case.ensemble.seed, **changed}


def _name_of(axis: Axis, row: Row) -> str:
    """The column of an axis in a row without it, with a name that differs from those of the results."""
    return f"{axis.name} (axis)" if axis.name in ("case", *row) else axis.name


def _results(record: Record) -> Row:
    outcome = record.outcome
    return {
        "time_s": record.case.summary.time_s if record.case.summary else record.last.get("time"),
        "depth_m": outcome.depth_m,
        "depth_is": outcome.depth_is,
        "rod_length_m": record.value("rod_length_m"),
        "rod_initial_length_m": record.value("rod_initial_length_m"),
        LENGTH_RATIO: outcome.length_ratio,
        "rod_max_radius_m": record.value("rod_max_radius_m"),
        RADIUS_RATIO: outcome.radius_ratio,
        "rod_tail_velocity_m_s": record.value("rod_tail_velocity_m_s"),
        "rod_mass_kg": record.value("rod_mass_kg"),
        RESIDUAL: raw(record, RESIDUAL),
        "regime": record.value("regime"),
        **{f"derived.{name}": record.numbers.get(f"derived.{name}") for name in record.derived},
    }


def _compared(record: Record, measurement: Measurement | None) -> Row:
    """The experiment and the error; unfinished runs have no error."""
    names = ("experiment_depth_m", "experiment_is", "experiment_source", "depth_error_m", "depth_error_percent",
             "depth_error_is")
    left, measured = raw(record, RESIDUAL), record.measured_residual
    compared = not (record.unfinished or left is None or measured is None)
    residual = {"experiment_residual_m_s": measured, "residual_error_m_s": left - measured if compared else None}
    if measurement is None:
        return dict.fromkeys(names) | residual
    comparable = not record.unfinished and record.depth is not None
    error, kind = measurement.error(record.outcome) if comparable else (None, None)
    per_cent = None if error is None else 100.0 * error / measurement.depth
    values = (measurement.depth, measurement.qualifier, measurement.source, error, per_cent, kind)
    return dict(zip(names, values, strict=True)) | residual


def _audit(summary: Summary) -> Row:
    """The largest relative changes, and the energy of every sink as a fraction of the energy at the start."""
    audit = summary.conservation or Conservation()
    masses = [change for change in audit.mass.values() if change is not None]
    row: Row = {
        "mass_change_worst": max(masses, key=abs, default=None),
        "momentum_change": audit.axial_momentum,
        "energy_change": audit.total_energy,
    }
    for name, amounts in audit.sinks.items():
        row[f"sink_{name}_share"] = ratio(amounts.energy_J, audit.start_energy_J)
    return row


def _cost(record: Record) -> Row:
    summary = record.case.summary
    row: Row = {name: summary[name] for name in ("cycles", "cells", "wall_s", "ns_per_cell_cycle")}
    row["cycles"] = record.value("cycles") if row["cycles"] is None else row["cycles"]
    return row | {"version": summary.version, "directory": str(record.case.directory)}


def with_responses(table: Sequence[Row], records: Sequence[Record], choice: Choice) -> list[Row]:
    """The rows with the drawn responses added in SI, if they are not among the columns."""
    added = [y.name for y in choice.y if y.name not in (DEPTH, *table[0])]
    return [row | {name: raw(record, name) for name in added} for row, record in zip(table, records, strict=True)]


def to_csv(table: Sequence[Row]) -> str:
    """The rows as CSV; numbers with all their digits."""
    safe = [{cell(name): _cell(value) for name, value in row.items()} for row in table]
    text = io.StringIO()
    writer = csv.DictWriter(text, dict.fromkeys(name for row in safe for name in row), lineterminator="\n")
    writer.writeheader()
    writer.writerows(safe)
    return text.getvalue()


def _cell(value):
    """A value of the table; empty for None and NaN."""
    if isinstance(value, str):
        return cell(value)
    return "" if value is None or value != value else value


@dataclass(frozen=True)
class Column:
    """A column of the page: its heading, the name of its value in a row, and how a value is shown."""

    head: str
    name: str
    show: Callable[[Row], str]
    number: bool = True


def _number(name: str, form: str, factor: float = 1.0) -> Callable[[Row], str]:
    return lambda row: "" if row.get(name) is None else form.format(float(row[name]) * factor).replace("-", "−")


def _word(name: str) -> Callable[[Row], str]:
    return lambda row: str(row.get(name) or "")


def _standing(row: Row) -> str:
    """The status of a case, or that it was cut with its projectile still moving."""
    return str(row["status"] == DONE and row.get("unfinished") or row["status"])


SIGNS = {"at least": "≥ ", "at most": "≤ ", "estimated": "≈ "}


def _qualified(name: str, qualifier: str, form: str, factor: float = 1.0) -> Callable[[Row], str]:
    """A number with the sign of its qualifier; a word if no error can be given."""
    number = _number(name, form, factor)

    def show(row: Row) -> str:
        if row.get(qualifier) == "none":
            return "reached"
        return SIGNS.get(str(row.get(qualifier)), "") + number(row)

    return show


def sinks(row: Row) -> list[tuple[str, float]]:
    """The largest sinks with their shares of the start energy, the largest first."""
    shares = [(name[5:-6], float(value)) for name, value in row.items()
              if name.startswith("sink_") and name.endswith("_share") and value is not None]
    largest = sorted(shares, key=lambda entry: -abs(entry[1]))[:NAMED_SINKS]
    return [entry for entry in largest if abs(entry[1]) >= SMALLEST_SHARE]


def _sinks(row: Row) -> str:
    named = "; ".join(f"{name.replace('_', ' ')} {share * 100:.2g} %".replace("-", "−") for name, share in sinks(row))
    return named or ("" if row["energy_change"] is None else "none")


def columns_of_results(study: Study, table: Sequence[Row], choice: Choice) -> list[Column]:
    """Axes, the impact velocity if it is not an axis, depth, experiment, projectile, drawn responses, status.

    Columns without values are left out.
    """
    depths = [
        Column("Depth [cm]", "depth_m", _qualified("depth_m", "depth_is", "{:.1f}", 100.0)),
        Column("Experiment [cm]", "experiment_depth_m", _qualified("experiment_depth_m", "experiment_is", "{:.1f}", 100.0)),
        Column("Error [cm]", "depth_error_m", _qualified("depth_error_m", "depth_error_is", "{:+.1f}", 100.0)),
        Column("Error [%]", "depth_error_percent", _qualified("depth_error_percent", "depth_error_is", "{:+.0f}")),
    ]
    rod = [
        Column("Length final / initial", "rod_length_ratio", _number("rod_length_ratio", "{:.3f}")),
        Column("Largest radius / initial", "rod_radius_ratio", _number("rod_radius_ratio", "{:.2f}")),
        Column("Residual velocity [m/s]", RESIDUAL, _number(RESIDUAL, "{:.0f}")),
        Column("Experiment [m/s]", "experiment_residual_m_s", _number("experiment_residual_m_s", "{:.0f}")),
        Column("Error [m/s]", "residual_error_m_s", _number("residual_error_m_s", "{:+.0f}")),
    ]
    derived = [name for name in table[0] if name.startswith("derived.")]
    shown = {DEPTH, *derived, *(column.name for column in rod)}
    drawn = [_of_response(y.name) for y in choice.y if y.name not in shown]
    speed = Column("Speed [m/s]", "velocity_m_s", _number("velocity_m_s", "{:.0f}"))
    known = {name for row in table for name, value in row.items() if value not in (None, "")}
    through = any(row.get(RESIDUAL) for row in table)
    optional = [
        *([] if any(map(is_velocity, study.axes)) else [speed]),
        *(depths[: 4 if "experiment_depth_m" in known else 1] if "target" in known else []),
        *(column for column in rod if column.name != RESIDUAL or through),
        *(Column(_said(name), name, _number(name, "{:.4g}")) for name in derived),
        *drawn,
        Column("Regime", "regime", _word("regime"), number=False),
    ]
    return [
        *(_of_axis(axis, table[0]) for axis in study.axes),
        *(column for column in optional if column.name in known),
        Column("Status", "status", _standing, number=False),
    ]


def _said(name: str) -> str:
    """The heading of a derived quantity: its name, and its SI unit if the name does not give it."""
    key = name.removeprefix("derived.")
    return key if unit(key) == "1" else f"{key} [{unit(key)}]"


def _of_axis(axis: Axis, row: Row) -> Column:
    name = f"{axis.name} (axis)" if f"{axis.name} (axis)" in row else axis.name
    return Column(axis.name, name, _word(name), number=False)


def _of_response(name: str) -> Column:
    quantity = response(name)
    return Column(quantity.title[0].upper() + quantity.title[1:], name, _number(name, "{:.4g}", quantity.factor))


def columns_of_audit() -> list[Column]:
    """Conservation and cost."""
    return [
        Column("Mass, worst body", "mass_change_worst", _number("mass_change_worst", "{:+.0e}")),
        Column("Axial momentum", "momentum_change", _number("momentum_change", "{:+.0e}")),
        Column("Total energy", "energy_change", _number("energy_change", "{:+.0e}")),
        Column("Largest sinks, share of start energy", "", _sinks, number=False),
        Column("Time [µs]", "time_s", _number("time_s", "{:.0f}", 1e6)),
        Column("Cycles", "cycles", _number("cycles", "{:.0f}")),
        Column("Wall time [s]", "wall_s", _number("wall_s", "{:.0f}")),
        Column("ns per cell and cycle", "ns_per_cell_cycle", _number("ns_per_cell_cycle", "{:.0f}")),
    ]
