"""The page in a real browser: on a phone, on a desktop, on paper."""

import json
from unicodedata import normalize

import pytest

from hydro2d.study.report.report import report
from tests.study import fake

AXES = {
    "velocity": fake.velocities(1086, 1200, 1296),
    "a rather long name of an axis": {
        "ke": ("numerics.advection=ke",),
        "momentum-conserving": ("numerics.advection=momentum",),
    },
}
PHONE, DESK = 360, 1440
SCHEMES = ("light", "dark")

#: helpers of the questions: contrast of two colours, the background behind an element, words that break into two lines
TOOLS = r"""
  const all = (selector) => [...document.querySelectorAll(selector)];
  const numbers = (colour) => colour.match(/[\d.]+/g).map(Number);
  const luminance = (colour) => {
    const [r, g, b] = numbers(colour).map((part) => part / 255)
      .map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (one, two) => {
    const [low, high] = [luminance(one), luminance(two)].sort((a, b) => a - b);
    return (high + 0.05) / (low + 0.05);
  };
  const behind = (element) => {
    for (let each = element; each; each = each.parentElement) {
      const colour = getComputedStyle(each).backgroundColor, parts = numbers(colour);
      if (parts.length === 3 || parts[3] > 0) return colour;
    }
    return "rgb(255, 255, 255)";
  };
  const faint = (elements, colour) => elements
    .filter((each) => contrast(colour(getComputedStyle(each)), behind(each)) < 4.5).map((each) => each.outerHTML.slice(0, 150));
  const torn = (element) => {
    const walker = document.createTreeWalker(element, NodeFilter.SHOW_TEXT), found = [], range = document.createRange();
    while (walker.nextNode())
      for (const match of walker.currentNode.textContent.matchAll(/[^\s]+/g)) {
        range.setStart(walker.currentNode, match.index);
        range.setEnd(walker.currentNode, match.index + match[0].length);
        if (new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size > 1) found.push(match[0]);
      }
    return found;
  };
  const right = (each) => each.getBoundingClientRect().right;
  const outside = (plot) => [...plot.querySelectorAll(".legendtext, .g-xtitle, .g-ytitle")].filter((each) => {
    const box = each.getBoundingClientRect(), around = plot.getBoundingClientRect();
    return box.left < around.left - 1 || box.right > around.right + 1 || box.bottom > around.bottom + 1;
  }).map((each) => each.textContent);
"""
STATE = (
    TOOLS
    + r"""
  all("details").forEach((each) => { each.open = true; });
  const text = all("p, h1, h2, h3, a, th, td, caption, figcaption, li, dt, dd, summary, .message, .tag")
    .filter((each) => each.textContent.trim());
  const drawn = all(".plotly-graph-div :is(.xtick, .ytick, .legend, .g-xtitle, .g-ytitle) text");
  const marks = all(".plotly-graph-div .points path").filter((each) => /fill: rgb\(1, 2, 3\)/.test(each.getAttribute("style")));
  return {
    inner: innerWidth,
    scroll: document.scrollingElement.scrollWidth,
    dark: matchMedia("(prefers-color-scheme: dark)").matches,
    paper: luminance(behind(document.body)),
    pictures: [...document.images].map((image) => image.naturalWidth),
    widest: Math.max(...all("img, .main-svg").map((each) => each.getBoundingClientRect().right)),
    plots: all(".plotly-graph-div").map((each) => each.querySelectorAll(".scatterlayer .trace").length),
    points: all(".scatterlayer .points path").length,
    faint: [...faint(text, (style) => style.color), ...faint([...drawn, ...marks], (style) => style.fill)],
    read: [text, drawn, marks].map((found) => found.length),
    cut: all(".plotly-graph-div").flatMap(outside),
    torn: all(".key, thead th").flatMap(torn),
    spilt: all("th .key span, th.key span").filter((each) => right(each) > right(each.closest("th")) + 1)
      .map((each) => each.textContent),
    keys: all("th.key").map((each) => each.textContent),
    requests: performance.getEntriesByType("resource").map((entry) => entry.name).filter((name) => !/^(data|blob):/.test(name)),
    boxes: all(".scroll").map((box) => getComputedStyle(box).overflowX),
    faults,
  };
"""
)
ASKED = r"""
  const plot = document.querySelector(".plotly-graph-div");
  const number = plot.data.findIndex((trace) => trace.name === "ke");
  Plotly.Fx.hover(plot, [{ curveNumber: number, pointNumber: 0 }]);
  const shown = [...plot.querySelectorAll(".hovertext text")].map((each) => each.textContent).join(" ");
  const ticks = () => [...plot.querySelectorAll(".xtick text")].map((each) => Number(each.textContent));
  const before = ticks();
  plot.querySelector(".modebar-btn[data-title='Zoom in']").click();
  await new Promise((done) => setTimeout(done, 500));
  const picture = await Plotly.toImage(plot, { format: "svg" });
  return {
    shown, before, after: ticks(), faults, picture: decodeURIComponent(picture),
    buttons: [...plot.querySelectorAll(".modebar-btn")].map((each) => each.dataset.title),
  };
"""
LINKS = r"""
  return [...document.querySelectorAll("a[download]")].map((each) => {
    const [head, body] = each.href.split(",");
    return { name: each.download, kind: head, start: atob(body).slice(0, 3000) };
  });
"""
SORT = """
  const table = document.querySelector("table.sortable");
  const names = () => [...table.tBodies[0].rows].map((row) => row.cells[0].textContent);
  const column = [...table.tHead.rows[0].cells].findIndex((cell) => cell.textContent.startsWith("Depth"));
  const head = table.tHead.rows[0].cells[column], found = {before: names()};
  head.querySelector("button").click();
  found.up = names(); found.upward = head.getAttribute("aria-sort");
  head.querySelector("button").click();
  found.down = names(); found.downward = head.getAttribute("aria-sort");
  table.tHead.rows[0].cells[0].querySelector("button").click();
  found.byName = names(); found.left = head.getAttribute("aria-sort");
  found.faults = faults;
  return found;
"""


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A study with a case that waits and one that failed with a long reason."""
    study = fake.write_study(tmp_path_factory.mktemp("browsed") / "study", AXES)
    failed = study / "cases" / "1086m-s_momentum-conserving"
    (failed / "failed.json").write_text('{"reason": "%s"}' % ("a_very_long_reason/" * 12))
    summary = json.loads((failed / "summary.json").read_text())
    del summary["sha256"]
    (failed / "summary.json").write_text(json.dumps(summary | {"status": "interrupted"}))
    for file in ("summary.json", "deck.toml", "history.h5"):
        (study / "cases" / "1296m-s_momentum-conserving" / file).unlink()
    return report([study], say=lambda line: None)


@pytest.mark.thorough
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("width", [PHONE, DESK])
def test_the_page_is_whole_alone_and_legible(browser, page, width, scheme):
    answer = browser.ask(page, STATE, width, scheme)
    assert answer["faults"] == []
    assert answer["inner"] == width
    assert answer["scroll"] <= width
    assert answer["widest"] <= width
    assert len(answer["pictures"]) == 1
    assert min(answer["pictures"]) > 0
    assert (answer["dark"], answer["paper"] < 0.05) == (scheme == "dark", scheme == "dark")
    assert len(answer["plots"]) == 2
    assert min(answer["plots"]) > 4
    assert answer["points"] == 4 + 1 + 3  # ended, unfinished, experiments
    assert min(answer["read"]) >= 3
    assert answer["faint"] == []
    assert answer["cut"] == []
    assert answer["torn"] == answer["spilt"] == []
    assert "body.rod.velocity" in answer["keys"]
    assert answer["requests"] == []
    assert set(answer["boxes"]) == {"auto"}


def test_values_zoom_and_pictures_are_offered(browser, page):
    answer = browser.ask(page, ASKED, DESK)
    assert answer["faults"] == []
    assert "1086m-s_ke" in answer["shown"]
    assert "depth [cm]: 35" in answer["shown"]
    assert max(answer["after"]) - min(answer["after"]) < max(answer["before"]) - min(answer["before"])
    assert "Download plot as a PNG" in answer["buttons"]
    assert not [title for title in answer["buttons"] if "loud" in title or "hare" in title]
    assert "impact velocity [m/s]" in answer["picture"]


def test_table_decks_and_pictures_can_be_saved(browser, page):
    links = {entry["name"]: entry for entry in browser.ask(page, LINKS, PHONE)}
    assert links["cases.csv"]["start"].startswith("case,velocity,")
    assert links["cases.csv"]["kind"] == "data:text/csv;charset=utf-8;base64"
    assert "[[body]]" in links["1086m-s_ke.toml"]["start"]
    assert links["rods_01.png"]["start"].startswith("\x89PNG")
    assert len(links) == 2 + 5  # a case has no deck


def test_faults_are_seen(browser, page, tmp_path):
    """An invalid picture, an error of a script, a request, a box that is too wide, a torn key and faint text are found."""
    spoilt = tmp_path / "spoilt.html"
    text = page.read_text(encoding="utf-8")
    wrong = ('<img alt="x" src="data:image/png;base64,AAAA"><img alt="y" src="https://example.invalid/x.png">'
             '<div style="width: 900px">wide</div><script>nothing.there();</script>')
    wrong += '<p style="color: #222">faint</p><p class="key" style="width: 3em; word-break: break-all">body.anotherlongword</p>'
    spoilt.write_text(text.replace("</main>", f"{wrong}</main>"), encoding="utf-8")
    answer = browser.ask(spoilt, STATE, PHONE, "dark")
    said = " ".join(answer["faults"])
    assert "nothing is not defined" in said
    assert "fetched https://example.invalid/x.png" in said
    assert 'alt="x"' in said
    assert answer["pictures"].count(0) == 2
    assert answer["torn"] == ["body.anotherlongword"]
    assert ["faint" in each for each in answer["faint"]] == [True]
    assert answer["scroll"] > PHONE


def test_tables_are_sorted(browser, page):
    answer = browser.ask(page, SORT, DESK)
    assert answer["faults"] == []
    by_depth = [
        name for name in answer["before"] if name != "1296m-s_momentum-conserving"
    ]  # depths fall in the order of the study
    assert answer["up"] == [*reversed(by_depth), "1296m-s_momentum-conserving"]
    assert answer["down"] == [*by_depth, "1296m-s_momentum-conserving"]
    assert answer["byName"] == sorted(answer["before"])
    assert (answer["upward"], answer["downward"], answer["left"]) == ("ascending", "descending", None)


def test_a_link_opens_a_folded_case(browser, page):
    script = """
      location.hash = document.querySelector("tbody th a").getAttribute("href");
      await new Promise((done) => setTimeout(done, 500));
      return [...document.querySelectorAll("details[open]")].map((each) => each.textContent.trim().slice(0, 10));
    """
    assert browser.ask(page, script, PHONE) == ["1086m-s_ke"]


def sheets(file):
    """The text of every printed page, without blanks."""
    pypdf = pytest.importorskip("pypdf", reason="pypdf reads the printed page")
    return ["".join(normalize("NFKC", sheet.extract_text()).split()) for sheet in pypdf.PdfReader(file).pages]


def test_it_prints(browser, page):
    printed = sheets(browser.pdf(page))
    text = "".join(printed)
    for word in (
        "1086m-s_ke",
        "1200m-s_momentum-conserving",
        "1296m-s_momentum-conserving",
        "Regime",
        "Status",
        "a_very_long_reason",
    ):
        assert word in printed[0]
    assert "advection0.81%" in text
    assert text.count("impactvelocity[m/s]") == 1  # of the figure
    assert "c0ffee" in text  # folded on the screen, open on paper
    assert "decksshare" not in text  # what all decks share is left out
    assert len(printed) < 15


def test_headings_are_repeated_on_paper(browser, page, tmp_path):
    """A table of several sheets, made from one of the page's rows."""
    text = page.read_text(encoding="utf-8")
    row = text[text.index("<tbody>") + len("<tbody>") :].split("</tr>")[0] + "</tr>"
    long = tmp_path / "long.html"
    long.write_text(text.replace("</tbody>", row * 90 + "</tbody>", 1), encoding="utf-8")
    printed = sheets(browser.pdf(long))
    headed = ["Regime" in sheet for sheet in printed if sheet.count("1086m-s_ke") > 5]
    assert len(headed) > 1
    assert all(headed)


#: labels of the ticks of the x axis of the first figure
TICKS = """
  const plot = document.querySelector(".js-plotly-plot");
  return [...plot.querySelectorAll(".xtick text, .xtick2 text")].map((each) => each.textContent);
"""


@pytest.mark.thorough
@pytest.mark.parametrize(("speeds", "shown"), [((1500,), ["1500"]), ((1500, 1500.5), ["1500", "1500.5"]),
                                               ((9000, 12000), ["9000", "12000"])])
def test_ticks_are_numbers_as_decks_write_them(browser, tmp_path, speeds, shown):
    """Without separators of thousands, and at the velocity itself where there is one."""
    study = fake.write_study(tmp_path / "study", {"velocity": fake.velocities(*speeds)})
    answer = browser.ask(report([study], y=["rod_length_m"], say=lambda line: None), TICKS, DESK)
    assert set(shown) <= set(answer)
    assert not any("," in label for label in answer)
    assert len(speeds) > 1 or answer == shown
