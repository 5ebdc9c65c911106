"""The page of `hydro2d view`: its numbers are those of the run within the error that it states, it is one small file, and one
message says what cannot be shown."""

import base64
import html
import json
import re
import webbrowser
import zlib

import numpy as np
import pytest

import hydro2d
from hydro2d.base.units import reader_unit
from hydro2d.cli.main import call
from hydro2d.materials.quantities import FieldError
from hydro2d.output import history, vtk
from hydro2d.results.viewer import packing, page_contents
from hydro2d.results.viewer.field_arrays import CLIPS, Ranges, ViewError
from tests.results import made_run


class Page:
    """A page read back in the way its program reads it."""

    def __init__(self, text: str):
        self.text = text
        match = re.search(r'<script type="application/json" id="contents">(.*?)</script>', text, re.S)
        self.about = json.loads(match[1])
        self.runs = self.about["runs"]
        self.numbers = [base64.b64decode(each) for each in re.findall(r'class="numbers">([^<]*)</script>', text)]

    def values(self, run: int, n: int, word: str) -> np.ndarray:
        """A field at dump n in the reader's unit, shape (nz, nr)."""
        table = self.runs[run]
        shape = len(table["z_edges"]) - 1, len(table["r_edges"]) - 1
        low, high, *place = table["pieces"][n][table["stored"].index(word)]
        if not place:
            return np.full(shape, low)
        data = np.frombuffer(self._inflated(run, place), np.uint8).astype(np.uint16).reshape(2, *shape)
        levels = np.cumsum(np.cumsum(data[0] << 8 | data[1], axis=0, dtype=np.uint16), axis=1, dtype=np.uint16)
        last = 2 ** table["bits"] - 2
        return np.where(levels > last, np.nan, low + (high - low) / last * levels.astype(float))

    def column(self, run: int, name: str) -> np.ndarray:
        """A column of the history in the reader's unit; `time` in s."""
        table = self.runs[run]["history"]
        kind = "<f8" if name == "time" else "<f4"
        piece = table["time"] if name == "time" else next(each["piece"] for each in table["columns"] if each["name"] == name)
        data = np.frombuffer(self._inflated(run, piece), np.uint8)
        return np.ascontiguousarray(data.reshape(np.dtype(kind).itemsize, -1).T).view(kind)[:, 0]

    def _inflated(self, run: int, place: list[int]) -> bytes:
        assert place[0] % 3 == 0  # every piece can be cut out of the text
        return zlib.decompress(self.numbers[run][place[0] : place[0] + place[1]])

    def error(self, run: int, n: int, word: str) -> float:
        """The largest error that the page states for a field at dump n."""
        low, high, *_ = self.runs[run]["pieces"][n][self.runs[run]["stored"].index(word)]
        return 0.5 * (high - low) / (2 ** self.runs[run]["bits"] - 2)


@pytest.fixture(scope="module")
def shot(tmp_path_factory):
    """A run whose mesh travels, with a tracer and a gauge."""
    return hydro2d.open_run(made_run.write(tmp_path_factory.mktemp("view") / "shot", travels=True, noise=0.02))


@pytest.mark.parametrize("bits", packing.BITS)
def test_fields_are_those_of_the_dumps_within_the_stated_error(shot, bits):
    page = Page(shot.view(bits=bits).html)
    assert page.runs[0]["times"] == [time for time, _ in shot.dumps]
    for n, (_, file) in enumerate(shot.dumps):
        dump, stored = vtk.read_grid(file), page.runs[0]["stored"]
        assert {"pressure", "velocity:r", "velocity:z", "body_temperature:rod", "volume_fraction:plate"} <= set(stored)
        for word in stored:
            values, unit = field_of(dump, word)
            scale = reader_unit(unit)[1]
            off = np.max(np.abs(page.values(0, n, word) - values * scale))
            assert off <= page.error(0, n, word) * 1.001 + 1e-6 * np.max(np.abs(values * scale))
            if word == "material":
                assert off == 0.0


def field_of(dump, word):
    """Values in SI of a stored field by its name in the file, and its unit."""
    key, _, part = word.partition(":")
    names = {"pressure": "Pressure [Pa]", "density": "Density [kg/m3]", "von_mises": "Von Mises Stress [Pa]",
             "temperature": "Temperature [K]", "plastic_strain": "Plastic Strain", "material": "Material",
             "body_temperature": f"Temperature of {part} [K]", "volume_fraction": f"Volume Fraction for {part}",
             "velocity": "Velocity [m/s]"}
    values = dump.fields[names[key]].astype(float)
    unit = names[key].partition("[")[2].rstrip("]")
    return (values[..., "rz".index(part)] if key == "velocity" else values), unit


def test_fewer_bits_take_less_room(shot):
    sizes = [len(Page(shot.view(bits=bits).html).numbers[0]) for bits in packing.BITS]
    assert sizes == sorted(sizes)
    assert sizes[0] < 0.8 * sizes[-1]


def test_values_that_are_not_numbers_stay_empty():
    values = np.array([[0.0, np.nan], [2.0, 1.0]])
    levels = packing.levels_of(values, 0.0, 2.0, 8)
    np.testing.assert_array_equal(levels, [[0, 255], [254, 127]])


def test_the_mesh_of_each_dump_is_kept(shot):
    table = Page(shot.view().html).runs[0]
    for (_, file), shift in zip(shot.dumps, table["shifts"], strict=True):
        dump = vtk.read_grid(file)
        np.testing.assert_allclose(np.array(table["z_edges"]) + shift, dump.z_edges, rtol=0, atol=1e-15)
        np.testing.assert_array_equal(table["r_edges"], dump.r_edges)
    assert table["shifts"][-1] == pytest.approx(500.0 * 40e-6)


def test_the_history_and_the_stations_are_kept(shot):
    page = Page(shot.view().html)
    np.testing.assert_array_equal(page.column(0, "time"), shot.history["time"])
    for name, scale in (("penetration_depth_m", 1e3), ("rod_tail_velocity_m_s", 1.0), ("tracer_tip_z_m", 1e3)):
        np.testing.assert_allclose(page.column(0, name), shot.history[name] * scale, rtol=1e-7)
    assert [(each["kind"], each["name"]) for each in page.runs[0]["stations"]] == [("tracer", "tip"), ("gauge", "deep")]
    depth = next(each for each in page.runs[0]["history"]["columns"] if each["name"] == "penetration_depth_m")
    assert (depth["label"], depth["unit"]) == ("penetration depth", "mm")


def test_a_long_history_is_thinned_and_says_so(shot, monkeypatch):
    monkeypatch.setattr(page_contents, "ROWS", 30)
    page = Page(shot.view().html)
    assert page.runs[0]["history"]["step"] == 3
    np.testing.assert_array_equal(page.column(0, "time")[[0, 1, -1]], shot.history["time"][[0, 3, -1]])
    assert page.runs[0]["history"]["rows"] == len(page.column(0, "time")) == 28


def test_ten_thousand_cells_and_a_hundred_dumps_of_five_fields_are_below_ten_megabytes(tmp_path):
    """Each field has noise of a thousandth in all cells, which no compression removes; real shots have less."""
    run = made_run.write(tmp_path / "big", shape=(200, 50), dumps=100, noise=1e-3, names=list(made_run.SCALARS)[:5],
                         everywhere=True)
    shown = hydro2d.open_run(run).view()
    page = Page(shown.html)
    assert len(page.runs[0]["times"]) == 100
    assert len(page.runs[0]["stored"]) == 5 + 1 + 2
    assert np.unique(page.values(0, 50, "pressure")).size > 1000
    assert 4e6 < len(shown.html) < 10e6


def test_the_page_fetches_nothing(shot):
    text = shot.view().html
    assert "http:" not in text.replace("http-equiv", "")
    assert "https:" not in text
    assert not re.search(r"<(?:script|img|link|iframe)\b[^>]*\s(?:src|href)=", text)
    assert not re.search(r"@import|url\(|\bimport\s*\(|\bfetch\(|XMLHttpRequest|WebSocket", text)
    assert "default-src 'none'" in text


def test_names_of_others_end_no_element(tmp_path):
    run = made_run.write(tmp_path / "a<b", dumps=2)
    deck = (run / "deck.toml").read_text().replace("A made shot", "</script><img src=x onerror=alert(1)> {{numbers}}")
    (run / "deck.toml").write_text("\n".join(line for line in deck.splitlines() if not line.startswith("#")) + "\n")
    page = Page(hydro2d.open_run(run).view().html)
    assert page.runs[0]["title"] == "</script><img src=x onerror=alert(1)> {{numbers}}"
    assert "<img" not in page.text
    assert "<title>a&lt;b</title>" in page.text


def test_colour_ranges_leave_out_void_and_the_outermost_cells(shot):
    fields = {each["word"]: each for each in Page(shot.view().html).runs[0]["fields"]}
    pooled = []
    for _, file in shot.dumps:
        dump = vtk.read_grid(file)
        pooled.append(np.hypot(*np.moveaxis(dump.fields["Velocity [m/s]"][..., :2], -1, 0))[dump.filling().fraction >= 0.5])
    values = np.concatenate(pooled)
    assert fields["velocity"]["parts"] == ["velocity:r", "velocity:z"]
    for clip, (low, high) in zip(CLIPS, fields["velocity"]["ranges"], strict=True):
        assert low == pytest.approx(np.quantile(values, clip), rel=0.02, abs=2.0)
        assert high == pytest.approx(np.quantile(values, 1.0 - clip), rel=0.02)
    assert fields["volume_fraction:rod"]["ranges"][0] == [0.0, 1.0]


def test_ranges_of_nothing_are_zero():
    ranges = Ranges()
    ranges.add(np.ones((2, 2)), np.zeros((2, 2), dtype=bool))
    assert ranges.clipped() == [[0.0, 0.0]] * len(CLIPS)


def test_fields_that_are_asked_for_are_kept_with_those_that_are_always_there(shot):
    page = Page(shot.view(fields=["velocity"]).html)
    assert page.runs[0]["stored"] == ["velocity:r", "velocity:z", "material", "volume_fraction:rod", "volume_fraction:plate"]
    assert len(page.numbers[0]) < 0.7 * len(Page(shot.view().html).numbers[0])


def test_a_run_under_way_is_shown_as_far_as_it_is(tmp_path):
    run = made_run.write(tmp_path / "run", dumps=3, ended=False)
    (run / "vtk" / "dump_000003.vtr").write_bytes(b"half a dump")  # not yet in the series
    (run / "history.h5").unlink()
    page = Page(hydro2d.open_run(run).view().html)
    assert page.runs[0]["ended"] is None
    assert len(page.runs[0]["times"]) == 3
    assert (page.runs[0]["history"], page.runs[0]["stations"]) == (None, [])


def test_two_runs_share_a_page(shot, tmp_path):
    other = made_run.write(tmp_path / "other", shape=(40, 20), dumps=3)
    page = Page(shot.view(hydro2d.open_run(other)).html)
    assert [each["label"] for each in page.runs] == ["shot", "other"]
    for number, run in enumerate((shot, hydro2d.open_run(other))):
        expected = vtk.read_grid(run.dumps[1][1]).fields["Density [kg/m3]"] * 1e-3
        np.testing.assert_allclose(page.values(number, 1, "density"), expected, atol=page.error(number, 1, "density") * 1.001)


def test_a_notebook_gets_the_page_in_a_frame(shot):
    shown = shot.view()
    frame = shown._repr_html_()
    assert html.unescape(re.search(r'srcdoc="([^"]*)"', frame)[1]) == shown.html
    assert 'title="hydro2d view"' in frame


def test_the_command_writes_the_page_and_opens_it_where_there_is_a_display(tmp_path, monkeypatch, capsys):
    run, opened = made_run.write(tmp_path / "run", dumps=2), []
    monkeypatch.setattr(webbrowser, "open", lambda place: opened.append(place) or True)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert call(["view", str(run)]) == 0
    said = capsys.readouterr().out
    assert f"wrote {run / 'view.html'}" in said
    assert "no browser was opened" in said
    assert opened == []
    monkeypatch.setenv("DISPLAY", ":0")
    assert call(["view", str(run), "--no-open", "-o", str(tmp_path / "a.html")]) == 0
    assert opened == []
    assert call(["view", str(run), "-o", str(tmp_path / "a.html"), "--bits", "8", "--fields", "pressure"]) == 0
    assert opened == [(tmp_path / "a.html").as_uri()]
    assert "no browser" not in capsys.readouterr().out
    page = Page((tmp_path / "a.html").read_text(encoding="utf-8"))
    assert (page.runs[0]["bits"], page.runs[0]["stored"][0]) == (8, "pressure")


@pytest.fixture
def no_dumps(tmp_path):
    run = made_run.write(tmp_path / "bare", dumps=1)
    (run / "series.pvd").unlink()
    return run


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["{empty}"], "is not a run directory: it has no deck.toml"),
        (["{bare}"], "bare has no dumps to show; output.vtk_interval of the deck sets when they are written"),
        (["{run}", "--fields", "damage"], 'the dumps have no "damage", but density, material, pressure'),
        (["{run}", "--fields", "stress_rr"], "; up to version 0.3, stress_rr was the name of deviator_rr"),
        (["{run}", "--fields", "presure"], 'unknown field "presure"; did you mean "pressure"?'),
        (["{run}", "{run}", "{run}"], "a page shows one run, or two side by side: 3 are given"),
        (["{run}", "--bits", "9"], 'Invalid value "9" for --bits'),
        (["{run}", "-o", "{run}"], "run"),
    ],
)
def test_runs_that_cannot_be_shown_give_one_message(tmp_path, no_dumps, capsys, arguments, said):
    made_run.write(tmp_path / "run", dumps=2, names=["Pressure [Pa]", "Density [kg/m3]"])
    (tmp_path / "empty").mkdir()
    places = {name: str(tmp_path / name) for name in ("run", "empty", "bare")}
    status = call(["view", *(word.format(**places) for word in arguments)])
    printed = capsys.readouterr()
    assert status in (2, 4)
    assert said in printed.err
    assert "Traceback" not in printed.err
    assert len(printed.err.strip().splitlines()) == 1
    assert printed.out == ""


def test_errors_of_the_interface(shot):
    with pytest.raises(ViewError, match="9 bits for a value: must be 8, 10, 12, 14, 16"):
        shot.view(bits=9)
    with pytest.raises(FieldError, match="unknown field"):
        shot.view(fields=["presure"])


def test_dumps_of_two_meshes_are_refused(tmp_path):
    run = made_run.write(tmp_path / "run", dumps=2)
    other = made_run.write(tmp_path / "other", dumps=2, shape=(40, 20))
    (run / "vtk" / "dump_000001.vtr").write_bytes((other / "vtk" / "dump_000001.vtr").read_bytes())
    with pytest.raises(ViewError, match="the dumps have different meshes"):
        hydro2d.open_run(run).view()


def test_a_field_that_only_some_dumps_have(tmp_path):
    """After a restart with other output.fields: a field that the last dump lacks is there for the dumps that have it only."""
    run = made_run.write(tmp_path / "run", dumps=2)
    other = made_run.write(tmp_path / "other", dumps=2, names=["Density [kg/m3]"])
    (run / "vtk" / "dump_000001.vtr").write_bytes((other / "vtk" / "dump_000001.vtr").read_bytes())
    table = Page(hydro2d.open_run(run).view().html).runs[0]
    for word in ("pressure", "velocity:z", "body_temperature:rod"):
        pieces = [pieces[table["stored"].index(word)] for pieces in table["pieces"]]
        assert (pieces[0] is None, pieces[1]) == (False, None)


def test_times_that_are_no_numbers_are_refused(tmp_path):
    run = made_run.write(tmp_path / "run", dumps=2)
    series = (run / "series.pvd").read_text()
    (run / "series.pvd").write_text(re.sub(r"<!--.*?-->\s*", "", series).replace('timestep="0.0"', 'timestep="nan"'))
    with pytest.raises(ViewError, match="that are not finite numbers"):
        hydro2d.open_run(run).view()


def test_a_history_without_rows_is_none(tmp_path):
    run = made_run.write(tmp_path / "run", dumps=1)
    history.History(run / "history.h5").write()
    assert Page(hydro2d.open_run(run).view().html).runs[0]["history"] is None


def test_a_quantity_is_spoken_without_its_unit():
    assert history.spoken("penetration_depth_m") == "penetration depth"
    assert history.spoken("sink_outflow_momentum_N_s") == "sink outflow momentum"
    assert history.spoken("regime") == "regime"
