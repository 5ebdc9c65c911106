"""The page in a real browser: on a phone, on a desk, on paper."""

from unicodedata import normalize

import pytest

from hydro2d.study.report import report
from tests.study import fake

AXES = {
    "velocity": fake.velocities(1086, 1200, 1296),
    "a rather long name of an axis": {"ke": ("numerics.advection=ke",), "momentum": ("numerics.advection=momentum",)},
}
PHONE, DESK = 360, 1200

STATE = """
  return {
    inner: innerWidth,
    scroll: document.scrollingElement.scrollWidth,
    pictures: [...document.images].map((image) => image.naturalWidth),
    widest: Math.max(...[...document.images].map((image) => image.getBoundingClientRect().right)),
    requests: performance.getEntriesByType("resource").map((entry) => entry.name).filter((name) => !name.startsWith("data:")),
    boxes: [...document.querySelectorAll(".scroll")].map((box) => getComputedStyle(box).overflowX),
    faults,
  };
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
    (study / "cases" / "1086m-s_momentum" / "failed.json").write_text('{"reason": "%s"}' % ("a_very_long_reason/" * 12))
    for file in ("summary.json", "deck.toml", "history.h5"):
        (study / "cases" / "1296m-s_momentum" / file).unlink()
    return report([study], say=lambda line: None)


@pytest.mark.parametrize("width", [PHONE, DESK])
def test_the_page_loads_whole_and_alone(browser, page, width):
    found = browser.ask(page, STATE, width)
    assert found["faults"] == []
    assert found["inner"] == width
    assert found["scroll"] <= width
    assert found["widest"] <= width
    assert len(found["pictures"]) == 3
    assert min(found["pictures"]) > 0
    assert found["requests"] == []
    assert set(found["boxes"]) == {"auto"}


def test_faults_are_seen(browser, page, tmp_path):
    """A picture that is none, an error of a script, a request and a box that is too wide are found."""
    spoilt = tmp_path / "spoilt.html"
    text = page.read_text(encoding="utf-8")
    wrong = ('<img alt="x" src="data:image/png;base64,AAAA"><img alt="y" src="https://example.invalid/x.png">'
             '<div style="width: 900px">wide</div><script>nothing.there();</script>')  # fmt: skip
    spoilt.write_text(text.replace("</main>", f"{wrong}</main>"), encoding="utf-8")
    found = browser.ask(spoilt, STATE, PHONE)
    said = " ".join(found["faults"])
    assert "nothing is not defined" in said
    assert "fetched https://example.invalid/x.png" in said
    assert 'alt="x"' in said
    assert found["pictures"].count(0) == 2
    assert found["scroll"] > PHONE


def test_tables_are_sorted(browser, page):
    found = browser.ask(page, SORT, DESK)
    assert found["faults"] == []
    by_depth = [name for name in found["before"] if name != "1296m-s_momentum"]  # depths fall in the order of the study
    assert found["up"] == [*reversed(by_depth), "1296m-s_momentum"]
    assert found["down"] == [*by_depth, "1296m-s_momentum"]
    assert found["byName"] == sorted(found["before"])
    assert (found["upward"], found["downward"], found["left"]) == ("ascending", "descending", None)


def test_a_link_opens_a_folded_case(browser, page):
    script = """
      location.hash = document.querySelector("tbody th a").getAttribute("href");
      dispatchEvent(new HashChangeEvent("hashchange"));
      return [...document.querySelectorAll("details")].filter((each) => each.open).map((each) => each.id);
    """
    assert browser.ask(page, script, PHONE) == ["case-0"]


def sheets(file):
    """The text of every printed page, without blanks."""
    pypdf = pytest.importorskip("pypdf", reason="pypdf reads the printed page")
    return ["".join(normalize("NFKC", sheet.extract_text()).split()) for sheet in pypdf.PdfReader(file).pages]


def test_it_prints(browser, page):
    printed = sheets(browser.pdf(page))
    text = "".join(printed)
    for word in ("1086m-s_ke", "1200m-s_momentum", "1296m-s_momentum", "Regime", "Status", "a_very_long_reason"):
        assert word in printed[0]
    assert "advection0.81%" in text
    assert "c0ffee" in text  # folded on the screen, open on paper
    assert "decksshare" not in text  # what all decks share is left out
    assert len(printed) < 15


def test_headings_are_repeated_on_paper(browser, page, tmp_path):
    """A table of several sheets, made of one of the page's rows."""
    text = page.read_text(encoding="utf-8")
    row = text[text.index("<tbody>") + len("<tbody>") :].split("</tr>")[0] + "</tr>"
    long = tmp_path / "long.html"
    long.write_text(text.replace("</tbody>", row * 90 + "</tbody>", 1), encoding="utf-8")
    printed = sheets(browser.pdf(long))
    headed = ["Regime" in sheet for sheet in printed if sheet.count("1086m-s_ke") > 5]
    assert len(headed) > 1
    assert all(headed)
