"""What is read from a disk, and what writes names into a format: each place is on a list, with what attacks or guards it."""

import ast
from collections.abc import Iterator

from tests.rules import source
from tests.trials.readers import READERS

#: calls that read, by their last word where any object can have them, and in full where only a library has them
READ_BY_ANY = {"open", "opened", "read_text", "read_bytes", "read_json", "verified", "verified_text", "readlink", "SetFileName"}
READ_BY_LIBRARY = {
    "os": {"open", "popen"}, "h5py": {"File"}, "json": {"load", "loads"},
    "tomllib": {"load", "loads"}, "pickle": {"load", "loads", "Unpickler"}, "marshal": {"load", "loads"},
    "csv": {"reader", "DictReader"}, "np": {"load", "loadtxt", "genfromtxt", "fromfile", "fromstring", "memmap"},
    "ElementTree": {"parse", "fromstring", "XML", "iterparse"}, "pyvista": {"read", "get_reader"}, "zipfile": {"ZipFile"},
    "tarfile": {"open"}, "gzip": {"open"}, "pandas": {"read_csv", "read_json", "read_hdf"}, "shelve": {"open"},
    "subprocess": {"run", "Popen", "check_output"},
}


def calls() -> Iterator[tuple[str, str, ast.Call]]:
    """Every call of the program: the module and function that makes it, the words of what is called, and the call."""
    for name, file in source.modules().items():
        yield from _calls(source.tree(file), name)


def _calls(node: ast.AST, place: str) -> Iterator[tuple[str, str, ast.Call]]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Call):
            yield place, ast.unparse(child.func), child
        inner = isinstance(child, (ast.FunctionDef, ast.ClassDef))
        yield from _calls(child, f"{place}.{child.name}" if inner else place)


def _only_writes(call: ast.Call) -> bool:
    modes = [each.value for each in (*call.args, *(word.value for word in call.keywords if word.arg == "mode"))
             if isinstance(each, ast.Constant) and isinstance(each.value, str)]
    return any(mode in ("w", "a", "wb", "ab", "x") for mode in modes)


def readers() -> set[str]:
    """Every place of the program that reads something from a disk or from another process, as MODULE.FUNCTION: CALL."""
    found = set()
    for place, words, call in calls():
        owner, _, last = words.rpartition(".")
        if (last in READ_BY_ANY or last in READ_BY_LIBRARY.get(owner, ())) and not _only_writes(call):
            found.add(f"{place}: {words if owner in READ_BY_LIBRARY else last}")
    return found


PACKAGE = "files of the package, which come with the program"
OURS = "a file that this process has just written, or a stream of its own"
NOTHING = "reads no contents: a device, a folder, or no file at all"
#: what attacks each reader: an entry of tests.trials.readers, or a test; or why nothing need
READ = {
    "deck": {"files.whole.read_text: opened", "files.strange.opened: open", "files.strange.opened.opener: os.open",
             "files.toml.read: read_text", "files.toml.parse: tomllib.loads", "files.key_lines._first_lines: tomllib.loads"},
    "study": {"study.plan.definition.read: read_text"},
    "model": {"materials.outside.read: read_text"},
    "table of an equation of state": {"cli.check_model.check: read_text"},
    "results of one's own": {"materials.from_files._take_text: read_text"},  # and tables
    "measured flow stresses": {"materials.fitting.read_points: read_text"},
    "kept rows": {"files.csv_tables.lines: csv.reader", "files.csv_tables.lines: read_text"},  # and samples, and their points
    "compilation": {"jit.compilation.progress_of: opened"},
    "lock": {"files.locks.holder: opened", "files.locks.locked: opened"},
    "progress": {"results.summaries.table_of: read_json"},
    "history": {"output.history._opened: h5py.File", "output.foreign._length_of_texts: open",
                "files.checksums._verified: open"},
    "restart": {"output.snapshot.read: h5py.File", "output.snapshot.read: json.loads",
                "results.reading.Results.simulation: tomllib.loads"},
    "deck of a run": {"results.reading.Results.__init__: tomllib.loads", "results.reading.Results.__init__: verified_text",
                      "running.run.check_same_deck: tomllib.loads", "study.records.record._read_deck: tomllib.loads",
                      "study.records.record._read_deck: verified_text",
                      "study.records.study_directory.Case.deck: tomllib.loads",
                      "study.records.study_directory._text: verified_text", "study.run.case._can_continue: verified_text",
                      "files.checksums.verified_text: verified"},
    "summary": {"files.whole.read_json: json.loads", "files.whole.read_json: verified_text"},
    "series": {"output.vtk.read_series: ElementTree.fromstring", "output.vtk.read_series: verified"},
    "dump": {"output.vtk._read: SetFileName", "output.foreign.check_vtk: open", "output.foreign._check_blocks: open"},
    "tests/trials/test_texts.py::test_absurd_settings": {"files.toml.assignment: tomllib.loads"},
    "tests/jit/test_store.py::test_a_damaged_file_is_compiled_anew_and_named": {
        "jit.store._rebuilt: pickle.loads", "jit.store._rebuilt: read_bytes"},
    "tests/jit/test_target.py::test_code_without_a_target_is_not_used": {"jit.shipped.say_if_unused: read_json"},
    "tests/jit/test_shipped.py::test_code_that_does_not_say_what_it_is_for_is_not_the_default": {
        "jit.shipped.default: read_json"},
    "tests/results/test_cutaway.py::test_cutaway_or_a_clear_error": {"results.cutaway.draw: subprocess.run"},
    "tests/jit/test_compilation.py::test_a_second_process_that_fails_is_said_to": {
        "jit.compilation.Second.start: subprocess.Popen"},
    "tests/running/test_provenance.py::test_git_and_the_processor_may_say_anything": {
        "running.provenance._git: subprocess.run", "running.provenance.processor: read_text"},
    PACKAGE: {"analytic.experience.table: csv.DictReader", "analytic.experience.table: open",
              "analytic.model_transition._rows: csv.DictReader", "analytic.model_transition._rows: open",
              "deck.templates.kinds: read_text", "deck.templates.text: read_text", "jit.cache._imported: read_text",
              "jit.cache.folder_for: read_bytes", "jit.shipped._mark: read_bytes", "jit.store._text_hash: read_bytes",
              "materials.library._library: read_text",
              "materials.outside.from_package: read_text", "results.viewer.page._asset: read_text"},
    OURS: {"files.checksums.seal: read_bytes", "output.vtk._write: SetFileName", "results.cutaway: json.load",
           "study.report.pictures.Picture.data: read_bytes", "running.bench_compilation.in_an_empty_cache: json.loads",
           "running.bench_compilation.in_an_empty_cache: subprocess.run"},
    NOTHING: {"base.children.detached: subprocess.Popen", "base.interrupt.lose_output: os.open",
              "base.interrupt.open_closed_streams: open", "base.interrupt.open_closed_streams: os.open",
              "cli.base.import_matplotlib: os.open", "cli.view._open: open", "files.locks.turn: os.open",
              "files.whole.sync: os.open", "solver.cycle.Cycle.prepare: open", "kernels.cracks.open_cracks: opened"},
}


def test_every_reader_is_attacked():
    listed = [f"hydro2d.{place}" for places in READ.values() for place in places]
    assert set(listed) == readers()
    assert len(listed) == len(set(listed))


def test_the_attacks_exist():
    for attack in READ.keys() - {PACKAGE, OURS, NOTHING} - READERS.keys():
        file, _, test = attack.partition("::")
        assert test in {node.name for node in source.tree(source.ROOT / file).body if isinstance(node, ast.FunctionDef)}, attack


#: the functions of the one module for names, and what figures call one of them
GUARDS = {node.name for node in source.tree(source.modules()["hydro2d.base.formats"]).body
          if isinstance(node, ast.FunctionDef)}
#: calls that write a name into a format, by their last word; where only those of some modules do, with these
WRITE = {
    "file": {"with_name", "with_stem", "joinpath", "Path"}, "HDF5": {"create_dataset", "create_group"}, "VTK": {"SetName"},
    "page": {"Markup", "escape", "quoteattr"}, "CSV": {"writer", "DictWriter"}, "JSON": {"dumps", "dump"},
    "shell": {"quote", "join"}, "rich": {"Text", "add_column"},
    "figure": {"set_title", "suptitle", "set_xlabel", "set_ylabel", "annotate", "set_xticks", "set_yticks"},
    "chart": {"add_scatter", "add_annotation", "update_xaxes", "update_yaxes"},
}
OWNERS = {"escape": {"html", ""}, "dumps": {"json"}, "dump": {"json"}, "join": {"shlex"}, "quote": {"shlex"},
          "writer": {"csv"}, "DictWriter": {"csv"}, "Path": {""}, "Text": {""}}


def _holds_a_name(part: ast.AST) -> bool:
    """Whether a text depends on more than constants and formatted numbers."""
    if isinstance(part, ast.JoinedStr):
        return any(isinstance(each, ast.FormattedValue) and not each.format_spec for each in part.values)
    return not isinstance(part, ast.Constant)


def _written(node: ast.AST) -> str | None:
    """The format into which a node may write a name."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div) and isinstance(node.right, ast.JoinedStr):
        return "file"
    if isinstance(node, ast.keyword) and node.arg == "label" and _holds_a_name(node.value):
        return "figure"
    if not isinstance(node, ast.Call):
        return None
    owner, _, last = ast.unparse(node.func).rpartition(".")
    given = [*node.args, *(word.value for word in node.keywords)]
    for kind, names in WRITE.items():
        if last in names and owner in OWNERS.get(last, {owner}):
            texts = [part for part in given if isinstance(part, ast.JoinedStr)] if kind == "file" else given
            return kind if any(map(_holds_a_name, texts)) else None
    return None


def _guards(syntax: ast.Module) -> set[str]:
    """The functions for names that a module imports or has."""
    imported = {alias.name for node in ast.walk(syntax) if isinstance(node, ast.ImportFrom) for alias in node.names}
    return GUARDS & imported | {"verbatim", "short"}


def unguarded() -> set[str]:
    """Places that may write a name into a format, in functions that call none of the functions for names, as PLACE: FORMAT."""
    found = set()
    for name, file in source.modules().items():
        for function in ast.walk(source.tree(file)):
            if not isinstance(function, ast.FunctionDef) or name == "hydro2d.base.formats":
                continue
            used = {ast.unparse(part).rpartition(".")[2] for part in ast.walk(function)
                    if isinstance(part, (ast.Name, ast.Attribute))}
            if not used & _guards(source.tree(file)):
                found |= {f"{name}.{function.name}: {kind}" for node in ast.walk(function) if (kind := _written(node))}
    return found


NUMBERS, WORDS, MADE, ELSEWHERE = (
    "the parts that vary are numbers, digits of a hash or words of a list in the program",
    "texts of the program: titles of models, units, names of quantities and columns",
    "the user's own file or folder, to whose name a word is added",
    "a library writes any text so that it is read back, or another function has been given the text",
)
#: places that may write a name, and call none of the functions for names: why they need not
UNGUARDED = {
    NUMBERS: {
        "api._base: file", "deck.templates.text: file", "jit.compilation._mark: file", "jit.recording.first_call: file",
        "jit.shipped._mark: file",
        "output.series._path: file", "running.compile_all.shipped_decks: file", "running.run._history: file",
        "study.report.pictures.draw: file", "study.report.pictures.films: file", "study.report.pictures.fitted: file",
        "study.report.charts._rear: chart", "study.report.charts._figure: chart", "study.report.rods._tidy: figure",
    },
    WORDS: {
        "analytic.fit_text.draw: figure", "analytic.fit_text.write_csv: CSV", "analytic.model_figures._lines: figure",
        "analytic.model_figures.draw: figure", "analytic.model_text.write_csv: CSV", "output.vtk._coordinates: VTK",
        "results.line_figures._labels: figure",
    },
    MADE: {"study.records.keeping.add: file",
           "cli.ensemble.converge: file", "cli.ensemble.run_all: file", "files.whole.replacing: file"},
    ELSEWHERE: {
        "cli.main.schema: JSON", "cli.model._show: JSON", "files.whole.write_json: JSON", "output.snapshot.texts: JSON",
        "output.snapshot.write: HDF5", "results.cutaway.draw: JSON", "running.bench_compilation.main: JSON",
        "solver.first_cycle.kernels: JSON", "deck.identity.setup: JSON",
        "output.history._write: HDF5", "output.history._write_debris: HDF5", "output.history._write_stations: HDF5",  # no /
        "output.vtk._array: VTK",  # in_xml, in _write
        "results.viewer.page._repr_html_: page",  # a whole page in an attribute
        "study.report.page.breakable: page",  # escape of markupsafe
        "running.progress._with_line: rich", "study.records.keeping._write: CSV", "study.report.charts._runs: chart",
        "study.report.divergence._draw: figure", "study.report.marks.ensembles: chart", "study.report.marks.points: chart",
        "study.report.rods.draw: figure", "study.report.uncertain._part: file", "study.report.uncertain._pictures: file",
    },
}


def test_every_writer_of_a_name_calls_the_function_of_its_format():
    """Or is on the list, with the reason."""
    listed = [f"hydro2d.{place}" for places in UNGUARDED.values() for place in places]
    assert set(listed) == unguarded()
    assert len(listed) == len(set(listed))


def test_nothing_else_escapes():
    """Only the module for names has the functions of libraries that quote and escape, but for whole pages and tables."""
    allowed = {"hydro2d.base.formats", "hydro2d.results.viewer.page", "hydro2d.study.report.page", "hydro2d.running.progress"}
    users = {name for name in source.modules() for other, _ in source.imports_of(name) if name not in allowed
             and other.partition(".")[0] in ("html", "shlex", "markupsafe", "xml") and not other.startswith("xml.etree")}
    assert users == set()
