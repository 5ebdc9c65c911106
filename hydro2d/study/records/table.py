"""The table of cases: one row of values in SI for each case, as CSV, and the columns shown on the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hydro2d.base.formats import cell
from hydro2d.measure.outcome import Outcome, ratio
from hydro2d.measure.result import unit
from hydro2d.measure.summary import Conservation, Summary
from hydro2d.study.records.experiments import Measurement
from hydro2d.study.records.record import Record
from hydro2d.study.records.responses import DEPTH, Choice, is_velocity, raw, response
from hydro2d.study.records.study_directory import DONE, Axis, Study

if TYPE_CHECKING:
    import pandas

#: largest number of sinks named on the page, and the smallest fraction of the start energy of one that is named
NAMED_SINKS, SMALLEST_SHARE = 3, 1e-6
#: results of a run, by their names in its summary and its outcome; the first ones have a median and a spread in an ensemble
SPREAD = ("depth_m", "rod_length_m", "length_ratio", "rod_max_radius_m", "radius_ratio", "rod_tail_velocity_m_s", "rod_mass_kg",
          "residual_velocity_m_s")
RESULTS = ("depth_m", "depth_is", "rod_length_m", "rod_initial_length_m", *SPREAD[2:], "regime")
#: beginnings of results of an outcome that the files of a report name with "rod_" before it, as figures do
OF_ROD = ("length_ratio", "radius_ratio", "residual_velocity")

Row = Mapping[str, object]


def cases(study: Study, records: Sequence[Record], measurements: Mapping[str, Measurement]) -> pandas.DataFrame:
    """One row for each case, by name and unit; None for missing values. ``measurements`` by case."""
    import pandas

    table = pandas.DataFrame([_row(study, record, measurements.get(record.case.name)) for record in records],
                             [record.case.name for record in records], dtype=object)
    return table.where(table.notna(), None)


def _row(study: Study, record: Record, measurement: Measurement | None) -> dict[str, object]:
    case, setup, summary = record.case, record.setup, record.case.summary
    row = {"status": case.status, "message": case.message, "unfinished": record.unfinished, "velocity_m_s": record.velocity}
    what = (setup.shape, setup.rod, setup.target, setup.nose, setup.thickness) if setup else (None,) * 5
    row |= zip(("projectile", "rod", "target", "nose", "target_thickness_m"), what, strict=True)
    row |= {"time_s": summary.time_s if summary else record.last.get("time")}
    row |= {name: record.outcome[name] if name in Outcome.model_fields else record.value(name) for name in RESULTS}
    row |= {f"derived.{name}": record.numbers.get(f"derived.{name}") for name in record.derived}
    row |= _compared(record, measurement) | _audit(summary) | {"cycles": record.value("cycles")}
    row |= {name: summary[name] for name in ("cells", "wall_s", "ns_per_cell_cycle", "version")}
    row["directory"] = str(case.directory)
    taken = in_files(["case", *row])
    axes = {f"{axis.name} (axis)" if axis.name in taken else axis.name: case.values.get(axis.name) for axis in study.axes}
    return {"case": case.name, **axes, **_member(study, record), **row}


def in_files(names: Sequence[str]) -> list[str]:
    """The heads of columns in the files of a report."""
    return [f"rod_{name}" if name.startswith(OF_ROD) else name for name in names]


def _member(study: Study, record: Record) -> dict[str, object]:
    """In an ensemble, the case that a run repeats, its number, the seed and the changes; None for any other run."""
    case = record.case
    changed = {name: case.changed.get(name) for each in study.ensembles for name in each.by}
    if case.ensemble is None:
        return dict.fromkeys(("ensemble", "member", "seed", *changed)) if study.ensembles else {}
    return {"ensemble": case.of, "member": case.member, "seed": case.ensemble.seed, **changed}


def _compared(record: Record, measurement: Measurement | None) -> dict[str, object]:
    """The experiment and the error; unfinished runs have no error."""
    left, measured = record.outcome.residual_velocity_m_s, record.measured_residual
    error, kind = None, None
    if measurement is not None and not record.unfinished and record.outcome.depth_m is not None:
        error, kind = measurement.error(record.outcome)
    return {
        "experiment_depth_m": measurement and measurement.depth, "experiment_is": measurement and measurement.qualifier,
        "experiment_source": measurement and measurement.source, "depth_error_m": error,
        "depth_error_percent": None if error is None else 100.0 * error / measurement.depth, "depth_error_is": kind,
        "experiment_residual_m_s": measured,
        "residual_error_m_s": None if record.unfinished or left is None or measured is None else left - measured,
    }


def _audit(summary: Summary) -> dict[str, object]:
    """The largest relative changes, and the energy of every sink as a fraction of the energy at the start."""
    audit = summary.conservation or Conservation()
    masses = [change for change in audit.mass.values() if change is not None]
    return {
        "mass_change_worst": max(masses, key=abs, default=None), "momentum_change": audit.axial_momentum,
        "energy_change": audit.total_energy,
        **{f"sink_{name}_share": ratio(amounts.energy_J, audit.start_energy_J) for name, amounts in audit.sinks.items()},
    }


def with_responses(table: pandas.DataFrame, records: Sequence[Record], choice: Choice) -> pandas.DataFrame:
    """The table with the drawn responses added in SI, if they are not among its columns."""
    import pandas

    names = [y.name for y in choice.y if y.name != DEPTH and y.name not in in_files(table)]
    return table.assign(**{name: pandas.Series([raw(record, name) for record in records], table.index, object)
                           for name in names})


def to_csv(table: pandas.DataFrame) -> str:
    """A table as CSV; numbers with all their digits."""
    text = table.map(lambda value: cell(value) if isinstance(value, str) else
                     "" if value is None or value != value else str(value))
    return text.to_csv(index=False, header=list(map(cell, in_files(table))), lineterminator="\n")


@dataclass(frozen=True)
class Column:
    """A column of the page: its heading, the name of its value in a row, and how a value is shown.

    form, factor : of a number;  qualifier : the column that says whether it is a bound
    """

    head: str
    name: str
    form: str = ""
    factor: float = 1.0
    qualifier: str = ""

    @property
    def number(self) -> bool:
        """Whether it has numbers, else words."""
        return bool(self.form)

    def show(self, row: Row) -> str:
        """The value of a row as text."""
        if self.name == "status":  # or that it was cut with its projectile still moving
            return str(row["status"] == DONE and row["unfinished"] or row["status"])
        if self.name == SINKS:
            return _sinks(row)
        value = row.get(self.name)
        if not self.number:
            return str(value or "")
        if row.get(self.qualifier) == "none":  # no error can be given
            return "reached"
        shown = "" if value is None else self.form.format(float(value) * self.factor).replace("-", "−")
        return SIGNS.get(str(row.get(self.qualifier)), "") + shown


SINKS = "sinks"
SIGNS = {"at least": "≥ ", "at most": "≤ ", "estimated": "≈ "}


def sinks(row: Row) -> list[tuple[str, float]]:
    """The largest sinks with their shares of the start energy, the largest first."""
    shares = [(name[5:-6], float(value)) for name, value in row.items()
              if name.startswith("sink_") and name.endswith("_share") and value is not None]
    largest = sorted(shares, key=lambda entry: -abs(entry[1]))[:NAMED_SINKS]
    return [entry for entry in largest if abs(entry[1]) >= SMALLEST_SHARE]


def _sinks(row: Row) -> str:
    named = "; ".join(f"{name.replace('_', ' ')} {share * 100:.2g} %".replace("-", "−") for name, share in sinks(row))
    return named or ("" if row["energy_change"] is None else "none")


def columns_of_results(study: Study, table: pandas.DataFrame, choice: Choice) -> list[Column]:
    """Axes, the impact velocity if it is not an axis, depth, experiment, projectile, drawn responses, status.

    Columns without values are left out.
    """
    depths = [
        Column("Depth [cm]", "depth_m", "{:.1f}", 100.0, "depth_is"),
        Column("Experiment [cm]", "experiment_depth_m", "{:.1f}", 100.0, "experiment_is"),
        Column("Error [cm]", "depth_error_m", "{:+.1f}", 100.0, "depth_error_is"),
        Column("Error [%]", "depth_error_percent", "{:+.0f}", 1.0, "depth_error_is"),
    ]
    rod = [
        Column("Length final / initial", "length_ratio", "{:.3f}"),
        Column("Largest radius / initial", "radius_ratio", "{:.2f}"),
        Column("Residual velocity [m/s]", "residual_velocity_m_s", "{:.0f}"),
        Column("Experiment [m/s]", "experiment_residual_m_s", "{:.0f}"),
        Column("Error [m/s]", "residual_error_m_s", "{:+.0f}"),
    ]
    derived = [name for name in table if name.startswith("derived.")]
    shown = {DEPTH, *derived, *in_files([column.name for column in rod])}
    drawn = [response(y.name) for y in choice.y if y.name not in shown]
    known = {name for name, column in table.items() if column.notna().any() and (column != "").any()}
    through = any(table["residual_velocity_m_s"])
    optional = [
        *([] if any(map(is_velocity, study.axes)) else [Column("Speed [m/s]", "velocity_m_s", "{:.0f}")]),
        *(depths[: 4 if "experiment_depth_m" in known else 1] if "target" in known else []),
        *(column for column in rod if column.name != "residual_velocity_m_s" or through),
        *(Column(_said(name), name, "{:.4g}") for name in derived),
        *(Column(y.title[0].upper() + y.title[1:], y.name, "{:.4g}", y.factor) for y in drawn),
        Column("Regime", "regime"),
    ]
    return [*(_of_axis(axis, table) for axis in study.axes), *(column for column in optional if column.name in known),
            Column("Status", "status")]


def _said(name: str) -> str:
    """The heading of a derived quantity: its name, and its SI unit if the name does not give it."""
    key = name.removeprefix("derived.")
    return key if unit(key) == "1" else f"{key} [{unit(key)}]"


def _of_axis(axis: Axis, table: pandas.DataFrame) -> Column:
    return Column(axis.name, f"{axis.name} (axis)" if f"{axis.name} (axis)" in table else axis.name)


def columns_of_audit() -> list[Column]:
    """Conservation and cost."""
    return [
        Column("Mass, worst body", "mass_change_worst", "{:+.0e}"), Column("Axial momentum", "momentum_change", "{:+.0e}"),
        Column("Total energy", "energy_change", "{:+.0e}"), Column("Largest sinks, share of start energy", SINKS),
        Column("Time [µs]", "time_s", "{:.0f}", 1e6), Column("Cycles", "cycles", "{:.0f}"),
        Column("Wall time [s]", "wall_s", "{:.0f}"), Column("ns per cell and cycle", "ns_per_cell_cycle", "{:.0f}"),
    ]
