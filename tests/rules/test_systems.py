"""hydro2d can be imported, and runs, where a system lacks what only Linux or macOS has."""

import ast

import pytest

from tests.rules import source

#: modules that Windows lacks, attributes that Windows or macOS lacks, and what starts a shell
MODULES = {"fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty"}
ATTRIBUTES = {
    "os": {"O_DIRECTORY", "O_NOFOLLOW", "O_NONBLOCK", "chown", "fchdir", "fchmod", "fork", "getloadavg", "getuid", "kill",
           "killpg", "mkfifo", "nice", "popen", "sched_getaffinity", "setsid", "statvfs", "sysconf", "system", "uname"},
    "signal": {"SIGALRM", "SIGCHLD", "SIGHUP", "SIGKILL", "SIGPIPE", "SIGQUIT", "SIGUSR1", "ITIMER_REAL", "alarm", "setitimer"},
}
#: where one of them is used behind a condition that it is there
GUARDED = {("hydro2d.base.interrupt", "signal.setitimer"), ("hydro2d.base.interrupt", "signal.ITIMER_REAL"),
           ("hydro2d.jit.cache", "os.getuid"), ("hydro2d.jit.compilation", "os.sched_getaffinity")}


def of_one_system(syntax: ast.AST) -> set[str]:
    """What a program uses of these: imports that do not catch ImportError, attributes, and shells."""
    if isinstance(syntax, ast.Try) and any("ImportError" in ast.unparse(each) for each in syntax.handlers):
        return set()
    found = {alias.name for alias in syntax.names} & MODULES if isinstance(syntax, ast.Import) else set()
    if isinstance(syntax, ast.ImportFrom) and syntax.module in MODULES:
        found = {syntax.module}
    if isinstance(syntax, ast.Attribute) and syntax.attr in ATTRIBUTES.get(ast.unparse(syntax.value), ()):
        found = {ast.unparse(syntax)}
    if isinstance(syntax, ast.keyword) and syntax.arg == "shell":
        found = {"shell"}
    return found.union(*map(of_one_system, ast.iter_child_nodes(syntax)))


@pytest.mark.parametrize("module", source.modules())
def test_what_only_some_systems_have_is_guarded(module: str):
    used = of_one_system(source.tree(source.modules()[module]))
    assert {name for name in used if (module, name) not in GUARDED} == set()


@pytest.mark.parametrize("text", ["import fcntl", "from resource import getrlimit", "os.getuid()", "f('x', shell=True)"])
def test_what_only_some_systems_have_is_found(text):
    assert of_one_system(ast.parse(text)) != set()
    assert of_one_system(ast.parse("try:\n    import fcntl\nexcept ImportError:\n    fcntl = None")) == set()


def test_every_guard_is_needed():
    used = {(module, name) for module, file in source.modules().items() for name in of_one_system(source.tree(file))}
    assert used == GUARDED
