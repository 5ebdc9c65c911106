"""The page of `hydro2d view` in a real browser: pictures, numbers, lines, histories, keys, on a desktop and on a phone."""

import numpy as np
import pytest

import hydro2d
from hydro2d.output import vtk
from tests.results import made_run

PHONE, DESK = 390, 1440
#: helpers of the questions: when the page is drawn, a pixel of a section, pointers that press and drag, keys
TOOLS = r"""
  const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
  const settled = async () => { await pause(50); while (drawnStep() !== state.step) await pause(20); await update(); };
  const drawnStep = () => Number(at("time").value);
  const canvas = () => SECTIONS[0].canvas;
  const colour = (x, y, section = SECTIONS[0]) => {
    const density = section.canvas.width / section.canvas.clientWidth;
    const place = [section.px(x) * density, section.py(y) * density].map(Math.floor);
    return [...section.canvas.getContext("2d").getImageData(...place, 1, 1).data].slice(0, 3);
  };
  const plain = () => { state.outlines = state.stations = false; for (const run of RUNS) run.measured.z = null; };
  const pointer = (name, px, py, more = {}) => {
    const box = canvas().getBoundingClientRect();
    canvas().setPointerCapture = () => {};
    canvas().dispatchEvent(new PointerEvent(name, { pointerId: 1, bubbles: true, cancelable: true, clientX: box.left + px,
      clientY: box.top + py, button: 0, buttons: name === "pointerup" ? 0 : 1, ...more }));
  };
  const drag = (from, to, more) => {
    pointer("pointerdown", ...from, more);
    for (const part of [0.3, 0.7, 1]) pointer("pointermove", ...from.map((value, k) => value + part * (to[k] - value)), more);
    pointer("pointerup", ...to, more);
  };
  const onCanvas = (x, y) => [SECTIONS[0].px(x), SECTIONS[0].py(y)];
  const middle = (j, i) => [RUNS[0].z_edges[j] + RUNS[0].z_edges[j + 1], RUNS[0].r_edges[i] + RUNS[0].r_edges[i + 1]]
    .map((sum) => 500 * sum);
  const key = (name, more = {}) => document.body.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true,
    cancelable: true, ...more }));
  addEventListener("unhandledrejection", (event) => faults.push(String(event.reason && event.reason.stack)));
  await settled();
"""
WHOLE = r"""
  const shifts = [];
  new PerformanceObserver((list) => { for (const each of list.getEntries()) shifts.push([each.value, each.startTime,
    ...each.sources.map((source) => source.node && (source.node.outerHTML || "").slice(0, 60))]); })
    .observe({ type: "layout-shift", buffered: true });
  state.probe = { x: 3, y: 2 }; state.line = [{ x: -20, y: 1 }, { x: 30, y: 4 }];
  for (const step of [0, 2, 4]) { await goTo(step); await pause(30); }
  const luminance = (text) => { const [r, g, b] = text.match(/[\d.]+/g).map(Number); return (r + g + b) / 765; };
  const named = (each) => each.getAttribute("aria-label") || each.ariaLabel || each.labels && each.labels.length
    || each.textContent.trim();
  const wide = [...document.querySelectorAll("body *")].filter((each) => each.getBoundingClientRect().right > innerWidth + 1
    && !each.closest("script, #said"));
  return {
    faults, shifts, inner: innerWidth, scroll: document.scrollingElement.scrollWidth,
    wide: wide.map((each) => each.outerHTML.slice(0, 99)),
    dark: matchMedia("(prefers-color-scheme: dark)").matches, paper: luminance(getComputedStyle(document.body).backgroundColor),
    requests: performance.getEntriesByType("resource").map((entry) => entry.name),
    bare: [...document.querySelectorAll("canvas, button, select, input, [role=region], dialog")]
      .filter((each) => !each.hasAttribute("aria-labelledby") && !named(each)).map((each) => each.outerHTML.slice(0, 99)),
    canvases: document.querySelectorAll("canvas").length, rows: document.querySelectorAll("#probe tbody tr").length,
    said: SECTIONS[0].canvas.getAttribute("aria-label"), time: at("time").getAttribute("aria-valuetext"),
  };
"""


@pytest.fixture(scope="module")
def shot(tmp_path_factory):
    """A run whose mesh travels."""
    return hydro2d.open_run(made_run.write(tmp_path_factory.mktemp("view") / "shot", travels=True))


@pytest.fixture(scope="module")
def page(shot, tmp_path_factory):
    return shot.view().save(tmp_path_factory.mktemp("page") / "view.html")


@pytest.fixture(scope="module")
def pair(shot, tmp_path_factory):
    """The page of this run together with one on another mesh, which ends earlier."""
    folder = tmp_path_factory.mktemp("pair")
    other = hydro2d.open_run(made_run.write(folder / "other", shape=(40, 20), dumps=4, time=30e-6, stations=False))
    return shot.view(other).save(folder / "view.html")


def ask(browser, page, script, width=DESK, scheme="light"):
    return browser.ask(page, TOOLS + script, width, scheme)


def dump(shot, n):
    return vtk.read_grid(shot.dumps[n][1])


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [PHONE, DESK])
def test_the_page_is_whole_on_a_desk_and_on_a_phone(browser, page, width, scheme):
    answer = ask(browser, page, WHOLE, width, scheme)
    assert answer["faults"] == []
    assert answer["inner"] == width
    assert answer["scroll"] <= width
    assert answer["wide"] == []
    assert (answer["dark"], answer["paper"] < 0.2) == (scheme == "dark", scheme == "dark")
    assert answer["requests"] == []
    assert answer["bare"] == []
    assert [each for each in answer["shifts"] if each[0] > 1e-3] == []
    assert answer["canvases"] == 1 + 1 + 5
    assert answer["rows"] > 15
    assert answer["said"] == ("Section of shot at t = 40.00 µs: Pressure [GPa] above, Von Mises Stress [GPa] below")
    assert answer["time"] == "40.00 µs"


def test_the_slider_changes_the_picture_and_colours_are_those_of_the_values(browser, page, shot):
    script = r"""
      plain();
      const found = [];
      for (const step of [1, 4]) {
        at("time").value = step;
        at("time").dispatchEvent(new Event("input"));
        await pause(100);
        await update();
        const scale = drawn.scales[0];
        const [x, y] = middle(37, 2);
        found.push({ low: scale.low, high: scale.high, colour: colour(x, y), mirror: colour(x, -y),
                     clock: at("clock").textContent });
      }
      return { found, map: MAPS.viridis, faults };
    """
    answer = ask(browser, page, script)
    assert answer["faults"] == []
    early, late = answer["found"]
    assert (early["clock"], late["clock"]) == ("10.00 µs", "40.00 µs")
    assert (early["low"], early["high"]) == (late["low"], late["high"])
    for n, shown in ((1, early), (4, late)):
        value = dump(shot, n).fields["Pressure [Pa]"][37, 2] * 1e-9
        position = min(max((value - shown["low"]) / (shown["high"] - shown["low"]), 0.0), 1.0)
        near = [answer["map"][min(max(int(position * 256) + step, 0), 255)] for step in (-1, 0, 1)]
        assert shown["colour"] in near
        assert shown["mirror"] not in near  # the lower half shows another field
    assert early["colour"] != late["colour"]


@pytest.mark.parametrize("width", [PHONE, DESK])
def test_each_half_has_its_own_bar_which_says_so(browser, page, width):
    """One bar if both halves show one field; otherwise one next to each half, with its name above and its unit along it."""
    script = r"""
      const words = [], plainFill = CanvasRenderingContext2D.prototype.fillText;
      CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
        const { a, b, c, d, e, f } = this.getTransform(), density = SECTIONS[0].canvas.width / SECTIONS[0].canvas.clientWidth;
        const place = [a * x + c * y + e, b * x + d * y + f].map((at) => at / density);
        if (this.canvas === SECTIONS[0].canvas) words.push([text, ...place]);
        plainFill.call(this, text, x, y);
      };
      const told = async (...chosen) => { state.words = chosen; await update(); words.length = 0; redraw();
        const { left, width } = SECTIONS[0].box; return words.filter(([, x]) => x > left + width + 5); };
      return { two: await told("pressure", "von_mises"), one: await told("pressure", "pressure"), axis: SECTIONS[0].py(
        SECTIONS[0].y(SECTIONS[0].box.top + SECTIONS[0].box.height / 2)), box: SECTIONS[0].box, faults };
    """
    answer = ask(browser, page, script, width)
    assert answer["faults"] == []
    top, middle, bottom = answer["box"]["top"], answer["axis"], answer["box"]["top"] + answer["box"]["height"]
    at = {text: y for text, _, y in answer["two"]}
    assert top <= at["upper half"] < top + 20
    assert middle <= at["lower half"] < middle + 20
    units = sorted(y for text, _, y in answer["two"] if text.endswith("[GPa]"))
    assert len(units) == 2
    assert at["upper half"] < units[0] < middle < at["lower half"] < units[1] < bottom
    assert not {"upper half", "lower half"} & {text for text, *_ in answer["one"]}
    assert len([text for text, *_ in answer["one"] if text.endswith("[GPa]")]) == 1
    assert max(x for _, x, _ in answer["two"]) < width


def test_a_late_picture_is_not_drawn_over_the_present_one(browser, page):
    script = """
      const run = RUNS[0], values = run.drawn.bind(run);
      run.drawn = async (n, word) => { if (n === 1) await pause(200); return values(n, word); };
      const slow = goTo(1), fast = goTo(3);
      await fast;
      const before = drawn;
      await slow;
      await pause(300);
      return { same: drawn === before, said: SECTIONS[0].when.textContent, faults };
    """
    assert ask(browser, page, script) == {"same": True, "said": "t = 30.00 µs", "faults": []}


def test_a_click_shows_the_numbers_of_the_cell(browser, page, shot):
    script = r"""
      const run = RUNS[0], found = {}, [x, y] = middle(30, 3);
      const place = onCanvas(x, -y);
      pointer("pointerdown", ...place);
      pointer("pointerup", ...place);
      for (const step of [4, 2]) {
        await goTo(step);
        found[step] = Object.fromEntries([...document.querySelectorAll("#probe tr[data-word]")].map((row) => [row.dataset.word,
          { value: Number(row.cells[1].dataset.value), shown: row.cells[1].textContent, error: run.error(step,
            run.byWord.has(row.dataset.word) ? row.dataset.word : "material") }]));
      }
      const [heads, rows] = probeTable();
      return { found, faults, csv: csv(heads, rows), least: run.last };
    """
    answer = ask(browser, page, script)
    assert answer["faults"] == []
    for n in (4, 2):
        read, answered = dump(shot, n), answer["found"][str(n)]
        expected = {
            "pressure": read.fields["Pressure [Pa]"][30, 3] * 1e-9, "density": read.fields["Density [kg/m3]"][30, 3] * 1e-3,
            "temperature": read.fields["Temperature [K]"][30, 3], "velocity:z": read.fields["Velocity [m/s]"][30, 3, 1],
            "velocity": np.hypot(*read.fields["Velocity [m/s]"][30, 3, :2]), "material": read.fields["Material"][30, 3],
            "volume_fraction:rod": read.fields["Volume Fraction for rod"][30, 3],
            "body_temperature:rod": read.fields["Temperature of rod [K]"][30, 3],
            "r": 1e3 * read.r_centres[3], "z": 1e3 * read.z_centres[30], "i": 3, "j": 30,
        }
        assert set(answered) >= set(expected)
        for word, value in expected.items():
            off = answered[word]["error"] * 1.001 + 1e-4 * (word in "rz")
            assert answered[word]["value"] == pytest.approx(value, abs=off, rel=1e-6)
    shown = answer["found"]["2"]["pressure"]["shown"].replace("−", "-")
    assert float(shown) == pytest.approx(dump(shot, 2).fields["Pressure [Pa]"][30, 3] * 1e-9, abs=2e-3)
    assert answer["csv"].startswith("quantity,unit,shot at 20.00 µs,largest error in shot\n")
    assert "Temperature of rod,K," in answer["csv"]


TAP = r"""
      plain();
      const [x, y] = middle(J, 3), place = onCanvas(x, -y), box = canvas().getBoundingClientRect();
      pointer("pointerdown", ...place, { pointerType: "touch" });
      pointer("pointerup", ...place, { pointerType: "touch" });
      await pause(100);
      await update();
      const tip = document.querySelector(".tip"), { left, right, top, bottom } = tip.getBoundingClientRect();
      const texts = (line) => [...line.children].map((part) => part.textContent);
      const lines = () => Object.fromEntries([...tip.children].map(texts));
      const finger = [box.left + place[0], box.top + place[1]];
      const first = lines(), beside = { left: left - finger[0], right: right - finger[0], top: top - finger[1],
        bottom: bottom - finger[1] }, within = left >= box.left && right <= box.right && top >= box.top && bottom <= box.bottom;
      const table = Math.round(document.querySelector("#probe table").getBoundingClientRect().top - finger[1]);
      await goTo(2);
      const later = lines();
      key("Escape");
      await pause(50);
      return { first, later, beside, within, table, shown: getComputedStyle(tip).display, hidden: tip.hidden, faults };
"""


@pytest.mark.parametrize("j", [14, 30, 40])
def test_a_tap_on_a_phone_shows_numbers_next_to_the_finger(browser, page, shot, j):
    answer = ask(browser, page, TAP.replace("J", str(j), 1), PHONE)
    assert answer["faults"] == []
    assert answer["within"]
    gaps = answer["beside"]
    away = max(gaps["left"], -gaps["right"], gaps["top"], -gaps["bottom"])  # below zero where it covers the finger
    assert 5 < away < 40
    assert answer["table"] > 500, "where all numbers are"
    for n, shown in ((4, answer["first"]), (2, answer["later"])):
        read = dump(shot, n)
        assert shown["z, r [mm]"].replace("−", "-") == f"{1e3 * read.z_centres[j]:.4g}, {1e3 * read.r_centres[3]:.4g}"
        assert shown["body"] == ("void", "rod", "plate")[read.fields["Material"][j, 3]]
        assert float(shown["Pressure [GPa]"].replace("−", "-")) == pytest.approx(
            read.fields["Pressure [Pa]"][j, 3] * 1e-9, abs=2e-3)
        assert "Velocity [m/s]" in shown
    assert answer["first"] != answer["later"]
    assert answer["hidden"], "with the mark"


def test_on_a_desktop_the_table_is_next_to_the_picture_only(browser, page):
    assert ask(browser, page, TAP.replace("J", "30", 1), DESK)["shown"] == "none"


@pytest.mark.parametrize("width", [PHONE, DESK])
def test_the_first_view_is_the_projectile(browser, page, shot, width):
    """The rod at all times with a rod's diameter around it, not the mesh, whose fine part alone is half as wide again."""
    script = r"""
      const { box } = SECTIONS[0], first = { ...state.view };
      const seen = [SECTIONS[0].x(box.left), SECTIONS[0].x(box.left + box.width)];
      const asked = SECTIONS[0].window("projectile");
      key("w");
      const whole = state.view.scale;
      key("m");
      const fine = state.view.scale;
      at("projectile").click();
      return { seen, asked, first, whole, fine, again: state.view, hidden: at("projectile").hidden, faults };
    """
    answer = ask(browser, page, script, width)
    assert answer["faults"] == []
    ends = []
    for n in range(len(shot.dumps)):
        read = dump(shot, n)
        rows = np.nonzero((read.fields["Volume Fraction for rod"] >= 0.5).any(axis=1))[0]
        moved = read.z_edges[0] - dump(shot, 0).z_edges[0]
        ends += [1e3 * (read.z_edges[rows[0]] - moved), 1e3 * (read.z_edges[rows[-1] + 1] - moved)]
    low, high = answer["asked"][:2]
    assert 3.0 < min(ends) - low < 10.0
    assert 3.0 < high - max(ends) < 10.0
    assert answer["seen"][0] <= low + 0.5
    assert answer["seen"][1] >= high - 0.5
    assert answer["again"] == pytest.approx(answer["first"])
    assert answer["whole"] < 0.9 * answer["first"]["scale"]
    assert not answer["hidden"]


def test_a_run_without_a_projectile_begins_with_the_fine_mesh(browser, tmp_path):
    directory = made_run.write(tmp_path / "run")
    deck = directory / "deck.toml"
    deck.write_text(deck.read_text().replace('rod = "rod"', 'rod = "none"'))
    page = hydro2d.open_run(directory).view().save(tmp_path / "view.html")
    answer = ask(browser, page, """return { same: SECTIONS[0].window("projectile").join() === SECTIONS[0].window("fine").join(),
      hidden: at("projectile").hidden, faults };""")
    assert answer == {"same": True, "hidden": True, "faults": []}


def test_a_drag_plots_along_the_line_and_follows_the_slider(browser, page, shot):
    script = r"""
      drag(onCanvas(-20, 1.2), onCanvas(15, 1.2));
      const card = document.querySelector(".chart.line"), found = {};
      for (const step of [1, 4]) {
        await goTo(step);
        const [{ x, y, r, z }] = card.found;
        found[step] = { x, r, z, y: y.map((each) => (Number.isFinite(each) ? each : null)),
                        error: RUNS[0].error(step, "pressure") };
      }
      const [heads] = lineTable(card);
      return { found, heads, title: card.querySelector("h2").textContent, probe: state.probe, faults };
    """
    answer = ask(browser, page, script)
    assert answer["faults"] == []
    assert answer["probe"] is None
    assert answer["title"] == "Along the line: Pressure [GPa]"
    assert answer["heads"] == ["distance [mm]", "r [mm]", "z [mm]", "Pressure [GPa]"]
    curves = []
    for n in (1, 4):
        shown, read = answer["found"][str(n)], dump(shot, n)
        assert shown["x"][-1] == pytest.approx(35.0, abs=0.3)
        i = np.searchsorted(read.r_edges, np.array(shown["r"]) * 1e-3) - 1
        j = np.searchsorted(read.z_edges, np.array(shown["z"]) * 1e-3) - 1
        solid = read.fields["Volume Fraction for rod"] + read.fields["Volume Fraction for plate"] >= 0.5
        expected = np.where(solid, read.fields["Pressure [Pa]"] * 1e-9, np.nan)[j, i]
        curves.append(np.array(shown["y"], dtype=float))
        assert np.mean(np.isnan(curves[-1]) != np.isnan(expected)) < 0.01  # a sample on an edge may fall into either cell
        assert np.nanquantile(np.abs(curves[-1] - expected), 0.98) <= shown["error"] * 1.01
        assert np.isfinite(curves[-1]).sum() > 200
    assert not np.array_equal(curves[0], curves[1], equal_nan=True)


def test_outlines_are_those_of_the_figures(browser, page, shot):
    script = r"""
      const shares = await RUNS[0].outlines(3);
      return { lengths: shares.map((segments) => {
        let sum = 0;
        for (let k = 0; k < segments.length; k += 4)
          sum += Math.hypot(segments[k + 2] - segments[k], segments[k + 3] - segments[k + 1]);
        return sum;
      }), faults };
    """
    answer, read = ask(browser, page, script), dump(shot, 3)
    assert answer["faults"] == []
    for body, length in zip(("rod", "plate"), answer["lengths"], strict=True):
        expected = sum(np.sum(np.hypot(*np.diff(line, axis=0).T)) for line in read.outlines(body))
        assert length == pytest.approx(expected, rel=2e-3)
        assert expected > 0.03


def test_tracers_and_gauges_stand_where_they_are(browser, page):
    script = """
      await goTo(2);
      const marked = drawn.found[0].places, [x, y] = SECTIONS[0].place(marked[0].r, marked[0].z);
      const before = colour(SECTIONS[0].x(x + 3.5), SECTIONS[0].y(y));
      at("stations").click();
      await pause(50);
      return { marked, before, after: colour(SECTIONS[0].x(x + 3.5), SECTIONS[0].y(y)), faults };
    """
    answer = ask(browser, page, script)
    assert answer["faults"] == []
    assert [(each["kind"], each["name"]) for each in answer["marked"]] == [("tracer", "tip"), ("gauge", "deep")]
    assert [each["z"] for each in answer["marked"]] == pytest.approx([19e-3, 12e-3], abs=1e-6)
    assert answer["marked"][0]["r"] == pytest.approx(1e-3)
    assert answer["before"] != answer["after"]


def test_a_click_on_a_history_goes_to_its_time(browser, page):
    script = """
      const card = document.querySelector(".chart.history"), plot = card.querySelector("canvas");
      const { left, top } = plot.getBoundingClientRect(), clientX = left + card.axis.px(19), clientY = top + 50;
      const said = [card.querySelector("select").value, card.querySelector(".value").textContent];
      plot.dispatchEvent(new PointerEvent("pointerdown", { clientX, clientY, buttons: 1 }));
      await pause(100);
      await update();
      const [heads, rows] = historyTable(card);
      return { said, step: state.step, value: card.querySelector(".value").textContent, heads, last: rows[80], faults };
    """
    answer = ask(browser, page, script)
    assert answer["faults"] == []
    assert answer["said"] == ["penetration_depth_m", "40 mm"]
    assert answer["step"] == 2
    assert answer["value"] == "20 mm"
    assert answer["heads"] == ["run", "time [µs]", "penetration depth [mm]"]
    assert answer["last"] == ["shot", pytest.approx(40.0), pytest.approx(40.0)]


def test_the_wheel_zooms_about_the_pointer_and_drags_move(browser, page):
    script = r"""
      const first = { ...state.view }, place = onCanvas(-20, 3);
      const { left, top } = canvas().getBoundingClientRect(), clientX = left + place[0], clientY = top + place[1];
      canvas().dispatchEvent(new WheelEvent("wheel", { deltaY: -400, cancelable: true, clientX, clientY }));
      const zoomed = { ...state.view }, still = onCanvas(-20, 3);
      drag([200, 100], [260, 120], { shiftKey: true });
      const moved = { ...state.view };
      at("drag").value = "pan"; at("drag").dispatchEvent(new Event("change"));
      drag([200, 100], [190, 100]);
      const again = { ...state.view };
      pointer("pointerdown", 200, 100); pointer("pointerdown", 300, 100, { pointerId: 2 });
      pointer("pointermove", 400, 100, { pointerId: 2 });
      const pinched = { ...state.view };
      pointer("pointerup", 200, 100); pointer("pointerup", 400, 100, { pointerId: 2 });
      canvas().dispatchEvent(new MouseEvent("dblclick"));
      const { view, line, probe } = state;
      return { first, zoomed, place, still, moved, again, pinched, last: view, line, probe, faults };
    """
    answer = ask(browser, page, script)
    assert answer["faults"] == []
    assert answer["zoomed"]["scale"] > 1.5 * answer["first"]["scale"]
    assert answer["still"] == pytest.approx(answer["place"], abs=1.0)  # places of the wheel are whole pixels
    scale = answer["zoomed"]["scale"]
    assert answer["moved"]["x"] == pytest.approx(answer["zoomed"]["x"] - 60 / scale)
    assert answer["moved"]["y"] == pytest.approx(answer["zoomed"]["y"] + 20 / scale)
    assert answer["again"]["x"] == pytest.approx(answer["moved"]["x"] + 10 / scale)
    assert answer["pinched"]["scale"] == pytest.approx(2 * answer["again"]["scale"])
    assert answer["last"] == pytest.approx(answer["first"])
    assert (answer["line"], answer["probe"]) == (None, None)


def test_ranges_clipping_logarithm_and_typed_limits(browser, page):
    script = r"""
      const range = () => [drawn.scales[0].low, drawn.scales[0].high];
      const pick = async (id, value) => {
        at(id).value = value;
        at(id).dispatchEvent(new Event("change"));
        await pause(60);
      };
      state.words[0] = "velocity";
      await pick("clip", "0");
      const all = range();
      await goTo(1);
      const same = range();
      await pick("range", "now");
      const now = range();
      await pick("clip", "4");
      const clipped = range();
      const low = at("half-0").querySelector(".low"), high = at("half-0").querySelector(".high");
      low.value = "100"; high.value = "400"; high.dispatchEvent(new Event("change"));
      await pause(60);
      const typed = range(), mode = at("range").value;
      at("log").click();
      await pause(60);
      const scale = drawn.scales[0];
      low.value = "500"; low.dispatchEvent(new Event("change"));
      await pause(60);
      return { all, same, now, clipped, typed, mode, log: [100, 200, 400].map(scale.position), refused: range(),
               said: at("said").textContent, faults };
    """
    answer = ask(browser, page, script)
    assert answer["faults"] == []
    assert answer["all"] == answer["same"]
    assert answer["now"] != answer["all"]
    assert answer["clipped"][1] < answer["now"][1]
    assert (answer["typed"], answer["mode"]) == ([100, 400], "own")
    assert answer["log"] == pytest.approx([0.0, 0.5, 1.0])
    assert answer["refused"] == [100, 400]
    assert "must be a number below the upper end" in answer["said"]


def test_keys(browser, page):
    script = r"""
      const steps = [];
      for (const name of ["Home", "ArrowRight", "ArrowRight", "ArrowLeft", "End"]) {
        key(name);
        await pause(40);
        steps.push(state.step);
      }
      const scale = state.view.scale;
      key("+"); key("+"); key("-");
      const zoomed = state.view.scale / scale;
      key("ArrowRight", { shiftKey: true });
      const x = state.view.x;
      key("w");
      const whole = state.view.scale;
      key("0");
      const fine = state.view.scale;
      key("f"); key("G"); key("r"); key("l"); key("p"); key("d");
      await pause(100);
      const after = { words: state.words, range: state.range, log: state.log, probe: state.probe !== null,
                      dark: document.documentElement.dataset.theme };
      key("?");
      const open = at("help").open;
      key("ArrowLeft");
      const asleep = state.step;
      at("help").close();
      key("Escape");
      await pause(50);
      const probe = state.probe;
      at("speed").value = "25";
      key(" ");
      const playing = state.playing, label = at("play").getAttribute("aria-label");
      await pause(1500);
      at("half-0").querySelector("select").dispatchEvent(new KeyboardEvent("keydown", { key: "d", bubbles: true }));
      return { steps, zoomed, x, whole, fine, after, open, asleep, probe, playing, label, ended: [state.step, state.playing],
               theme: document.documentElement.dataset.theme, faults };
    """
    answer = ask(browser, page, script)
    assert answer["faults"] == []
    assert answer["steps"] == [0, 1, 2, 1, 4]
    assert answer["zoomed"] == pytest.approx(1.25)
    assert answer["whole"] < 0.9 * answer["fine"]
    assert answer["after"] == {"words": ["density", "temperature"], "range": "now", "log": True, "probe": True, "dark": "dark"}
    assert (answer["open"], answer["asleep"], answer["probe"]) == (True, 4, None)
    assert (answer["playing"], answer["label"]) == (True, "Pause")
    assert answer["ended"] == [4, False]  # from the first to the last
    assert answer["theme"] == "dark"  # a key pressed in a choice belongs to the choice


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_dark_and_light_can_be_chosen(browser, page, scheme):
    script = """
      key("w");
      await pause(100);
      const paper = () => getComputedStyle(document.body).backgroundColor, before = paper(), void_ = colour(-40, 6);
      at("dark").click();
      await pause(100);
      return { before, after: paper(), void_, now: colour(-40, 6), pressed: at("dark").getAttribute("aria-pressed"), faults };
    """
    answer = ask(browser, page, script, scheme=scheme)
    assert answer["faults"] == []
    papers = {"light": "rgb(244, 245, 247)", "dark": "rgb(20, 23, 27)"}
    other = "light" if scheme == "dark" else "dark"
    assert (answer["before"], answer["after"]) == (papers[scheme], papers[other])
    assert answer["void_"] != answer["now"]
    assert answer["pressed"] == ("true" if other == "dark" else "false")


def test_two_runs_share_the_time_and_the_colours(browser, pair):
    script = r"""
      const found = [];
      for (const step of TIMES.keys()) {
        await goTo(step);
        found.push(SECTIONS.map((section) => [section.n, section.when.textContent]));
      }
      state.probe = { x: 5, y: 6 };
      await update();
      const head = [...document.querySelectorAll("#probe thead th")].map((each) => each.textContent);
      const row = document.querySelector("#probe tr[data-word=material]"), boxes = [...document.querySelectorAll(".section")]
        .map((each) => each.getBoundingClientRect());
      drag(onCanvas(0, 2), onCanvas(15, 2));
      await pause(100); await update();
      const line = document.querySelector(".chart.line"), offsets = SECTIONS.map((section) => section.offset);
      return { times: TIMES, found, head, cells: [...row.cells].slice(1, 3).map((each) => Number(each.dataset.value)), offsets,
        curves: line.found.length, beside: boxes[0].top === boxes[1].top && boxes[0].right < boxes[1].left,
        value: document.querySelector(".chart.history .value").textContent, heads: lineTable(line)[0], faults };
    """
    answer = ask(browser, pair, script)
    assert answer["faults"] == []
    assert answer["times"] == pytest.approx([0.0, 10e-6, 20e-6, 30e-6, 40e-6])
    assert [[n for n, _ in each] for each in answer["found"]] == [[0, 0], [1, 1], [2, 2], [3, 3], [4, 3]]
    assert answer["found"][4][1][1] == "t = 30.00 µs, its last"
    assert answer["head"] == ["", "shot", "other", "±"]
    assert answer["cells"] == [2, 2]
    assert answer["offsets"] == pytest.approx([20.0, 20.0])  # the same place in both
    assert answer["curves"] == 2
    assert answer["beside"]
    assert answer["value"] == "40 mm30 mm"
    assert answer["heads"][1] == "r of shot [mm]"


def test_two_runs_are_below_one_another_on_a_phone(browser, pair):
    script = """
      const boxes = [...document.querySelectorAll(".section")].map((each) => each.getBoundingClientRect());
      return { below: boxes[0].bottom < boxes[1].top, scroll: document.scrollingElement.scrollWidth, faults };
    """
    assert ask(browser, pair, script, PHONE) == {"below": True, "scroll": PHONE, "faults": []}


def test_a_planar_run_without_a_mirror_image_has_one_field(browser, tmp_path):
    run = made_run.write(tmp_path / "run", dumps=2, geometry="planar")
    deck = run / "deck.toml"
    lines = [line.replace('"axis"', '"outflow"') for line in deck.read_text().splitlines() if not line.startswith("#")]
    deck.write_text("\n".join(lines) + "\n")
    page = hydro2d.open_run(run).view().save(tmp_path / "view.html")
    script = """
      const empty = SECTIONS[0].cellAt({ x: 0, y: -2 });
      return { hidden: at("half-1").hidden, legend: at("half-0").querySelector("legend").textContent, empty, faults,
               bottom: SECTIONS[0].window(false)[2], cell: SECTIONS[0].cellAt({ x: 0, y: 2 }) !== null };
    """
    answer = ask(browser, page, script)
    assert answer == {"hidden": True, "legend": "Field", "empty": None, "faults": [], "bottom": 0, "cell": True}


def test_a_run_without_history_and_with_one_dump(browser, tmp_path):
    run = made_run.write(tmp_path / "run", dumps=1)
    (run / "history.h5").unlink()
    page = hydro2d.open_run(run).view().save(tmp_path / "view.html")
    answer = ask(browser, page, "key(' '); await pause(100); return { cards: at('charts').children.length, faults, "
                               "playing: state.playing, said: SECTIONS[0].when.textContent };")
    assert answer == {"cards": 1, "faults": [], "playing": False, "said": "t = 0.00 µs"}


def test_a_browser_that_is_too_old_gets_a_message(browser, page, tmp_path):
    old = tmp_path / "old.html"
    text = page.read_text(encoding="utf-8")
    old.write_text(text.replace("<head>", "<head><script>delete window.DecompressionStream;</script>"), encoding="utf-8")
    answer = browser.ask(old, """
      const seen = (selector) => getComputedStyle(document.querySelector(selector)).visibility;
      return { said: at("heading").textContent, header: seen("h1"), rest: seen("main"), faults };""", DESK)
    assert answer == {"said": "This browser is too old for this page: Chrome 80, Firefox 113 or Safari 16.4 can show it.",
                      "header": "visible", "rest": "hidden", "faults": []}
