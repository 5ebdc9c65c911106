"""The one door for tables in CSV: what is read and what is refused, by the columns that are declared."""

import random

import pytest

from hydro2d.base.errors import Error
from hydro2d.base.formats import cell
from hydro2d.files.csv_tables import Column, Row, flag, like, lines, number, one_of, read, whole

COLUMNS = (
    Column("row", whole, empty=False), Column("length [mm]", number), Column("state", one_of("done", "failed"), empty=False),
    Column("trusted", flag), Column("hash", like(r"[0-9a-f]{4}", "a hash of four digits"), required=False),
    Column("mass [kg]", number, required=False), Column("about"),
)
HEAD = "row,length [mm],state,trusted,about\n"
TEXT = HEAD + "1,2.5,done,True,a\n2,,failed,,\n"


def table(folder, text, **options):
    file = folder / "x.csv"
    file.write_bytes(text.encode())
    return read(file, COLUMNS, Error, "mend it", **options)


def test_a_table_is_read_by_its_columns(tmp_path):
    first, second = table(tmp_path, TEXT)
    assert first == {"row": "1", "length [mm]": "2.5", "state": "done", "trusted": "True", "about": "a"}
    assert second == {"row": "2", "length [mm]": "", "state": "failed", "trusted": "", "about": ""}
    assert (first.line, second.line, Row().line) == (2, 3, 0)


@pytest.mark.parametrize("text", [
    "\ufeff" + TEXT, TEXT.replace("\n", "\r\n"), TEXT.replace("\n", "\r"), TEXT + "\n\n", TEXT.rstrip(), TEXT + " , ,,,\n",
    TEXT.replace(",", " , "), TEXT.replace("\n", ",,\n"), TEXT.replace("done", '"done"'), TEXT.replace("True", "TRUE"),
    TEXT.replace("\n1", "\n\n\n01"),
])
def test_what_changes_no_value_is_read(tmp_path, text):
    assert table(tmp_path, text) == table(tmp_path, TEXT)


@pytest.mark.parametrize(("text", "said"), [
    ("", 'x.csv:1: has no column "row"; mend it'),
    ("row,state\n", 'x.csv:1: has no column "length [mm]"; mend it'),
    (HEAD.replace("state", "stte"), 'x.csv:1: has no column "state" (perhaps "stte" is meant); mend it'),
    (HEAD.replace(" [mm]", ""), 'x.csv:1: column "length": has no unit, and must be "length [mm]"; mend it'),
    ("mass," + HEAD, 'x.csv:1: column "mass": has no unit, and must be "mass [kg]"; mend it'),
    ("other," + HEAD, 'x.csv:1: unknown column "other" (allowed: about, hash, length [mm], mass [kg], row, state, trusted)'),
    ("about," + HEAD, 'x.csv:1: column "about": is there twice; mend it'),
    ("," + HEAD, "x.csv:1: column 1 has no head; mend it"),
    (HEAD + "1,2,done,,\n\n2,3,done\n", "x.csv:4: has 3 cells, and the line of heads 5; mend it"),
    (HEAD.replace("\n", ",\n") + "1,2,done,,,x\n", 'x.csv:2: "x" is in a column without a head; mend it'),
    (HEAD + ",2,done,,\n", 'x.csv:2: column "row": is empty; mend it'),
    (HEAD + '"1\n2",2,done,,\n', 'x.csv:2: column "row": "1\\n2" is not a whole number; mend it'),
    (HEAD + '1,2,done,,"a\nb"\n1,x,done,,\n', 'x.csv:4: column "length [mm]": "x" is not a number; mend it'),
    (HEAD + "1,2,gone,,\n", 'x.csv:2: column "state": unknown word "gone"; did you mean "done"? (allowed: done, failed)'),
    (HEAD + "1,2,done,yes,\n", 'x.csv:2: column "trusted": unknown word "Yes" (allowed: False, True); mend it'),
    ("hash," + HEAD + "1E+03,1,2,done,,\n", 'x.csv:2: column "hash": "1E+03" is not a hash of four digits; mend it'),
    (HEAD.replace(",", ";"), "x.csv: the cells are separated by semicolons; write commas, and points in numbers"),
    (HEAD + '1,"2,done\n', "x.csv:2: is not a table with commas: unexpected end of data"),
    *((f"{HEAD}{mark}\n", "x.csv:2: has a mark of git between two versions of the file; keep one of them")
      for mark in ("<<<<<<< HEAD", "=======", "||||||| 1a2b", ">>>>>>> branch")),
])
def test_what_is_not_as_declared_is_refused_in_one_line(tmp_path, text, said):
    with pytest.raises(Error) as error:
        table(tmp_path, text)
    assert str(error.value).startswith(f"{tmp_path}/{said}")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("text", ["1", "-1.5", "+.5", "1.", "1e-3", "1E+05", "0"])
def test_numbers(text):
    assert number(text) == text


@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "Infinity", "1_0", "1,5", "1 000", "٣", "0x1", "1e", "e1", "1e999",
                                  "--1", "1.2.3", "12:30", "2026-01-31", "#REF!", "1\n", "½", "1m"])
def test_no_numbers(text):
    with pytest.raises(ValueError, match="is not a"):
        number(text)


def test_a_text_that_a_spreadsheet_would_compute_comes_back(tmp_path):
    for text in ("=1+1", "-180 m/s", "@a", "+a"):
        assert table(tmp_path, HEAD + f"1,2,done,,{cell(text)}\n")[0]["about"] == text


def test_other_columns_by_their_heads(tmp_path):
    heads = HEAD.replace("\n", ",x.1\n") + "1,2,done,,,7\n"
    assert table(tmp_path, heads, others=Column)[0]["x.1"] == "7"
    with pytest.raises(Error, match='unknown column "x.1"'):
        table(tmp_path, heads, others=lambda head: None)


def test_no_text_makes_more_than_an_error(tmp_path):
    """500 texts with marks of tables in wrong places: each is read, or refused in one line."""
    chance, said = random.Random(73), []
    for _ in range(500):
        text = list(TEXT)
        for _ in range(chance.choice((1, 1, 2))):
            mark = chance.choice(("", ",", '"', "\n", "\r", ";", "'", "\0", "\ufeff", "=", "é", "\x85", " "))
            text[chance.randrange(len(text))] = mark
        try:
            table(tmp_path, "".join(text))
        except Error as error:
            said.append(str(error))
    assert 250 < len(said) < 500
    assert all(words.startswith(f"{tmp_path}/x.csv:") and "\n" not in words for words in said)


def test_lines_have_their_numbers(tmp_path):
    (tmp_path / "x.csv").write_text('a,b\n\n"1\n2", 3 \n4,5\n')
    assert lines(tmp_path / "x.csv", Error) == [(1, ["a", "b"]), (3, ["1\n2", "3"]), (5, ["4", "5"])]
