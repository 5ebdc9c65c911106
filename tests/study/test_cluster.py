"""Workers started by others, and those of SLURM."""

import resource
import socket
import subprocess
import sys
from contextlib import suppress
from types import SimpleNamespace

import distributed
import psutil
import pytest

import hydro2d
from hydro2d.cli.main import call
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.records import sample_table
from hydro2d.study.run import cluster
from tests.study import tubes

JOB = """
cores = 8
memory = "16 GB"
queue = "long"
job_script_prologue = ["module load python"]
"""


@pytest.fixture
def others():
    """A cluster started by somebody else, with the requested number of threads per worker."""
    started = []

    def start(threads):
        started.append(distributed.LocalCluster(n_workers=1, threads_per_worker=threads, dashboard_address=None))
        return started[-1].scheduler_address

    yield start
    for each in started:
        each.close()


@pytest.mark.thorough
def test_joins_a_running_cluster_and_leaves_it_running(tmp_path, others, capsys):
    file, address = tubes.write(tmp_path), others(1)
    assert call(["sweep", str(file), "--scheduler", address, "--out", str(tmp_path / "a")]) == 0
    assert {case.status for case in hydro2d.open_study(tmp_path / "a").cases} == {"done"}
    assert call(["sweep", str(file), "--scheduler", address, "--out", str(tmp_path / "b"), "--quiet"]) == 0
    assert "4 of 4 done" in capsys.readouterr().out
    files = sorted((tmp_path / "a").glob("cases/*/summary.json"))
    before = [file.stat().st_mtime_ns for file in files]
    assert call(["sweep", str(file), "--scheduler", address, "--out", str(tmp_path / "a"), "--overwrite"]) == 0
    assert all(file.stat().st_mtime_ns > then for file, then in zip(files, before, strict=True))


@pytest.mark.thorough
def test_members_on_a_cluster_have_the_bits_of_those_on_this_machine(tmp_path, others):
    ensemble = '[ensemble]\nrepeats = 2\nby = ["first step"]\n'
    file = tubes.write(tmp_path, tubes.STUDY + ensemble)
    only = ["--only", "ke_0.1*"]
    assert call(["sweep", str(file), "--scheduler", others(1), "--out", str(tmp_path / "cluster"), *only]) == 0
    assert call(["sweep", str(file), "--workers", "2", "--out", str(tmp_path / "here"), *only]) == 0
    names = ["ke_0.1", "ke_0.1_m1"]
    there, here = ([tubes.bits(tmp_path / place / "cases" / name) for name in names] for place in ("cluster", "here"))
    assert there == here
    assert here[0] != here[1]


@pytest.mark.thorough
def test_a_sample_on_a_cluster_is_the_same_table(tmp_path, others):
    study = 'title = "Tubes"\ndeck = "tube.toml"\n[set]\nstop.time = 0.01\n[sample]\nmethod = "sobol"\nn = 2\n'
    sample = 'by = ["first step"]\n[sample.input."body.low.pressure"]\nuniform = [0.1, 0.2]\n'
    file = tubes.write(tmp_path, study + sample)
    assert call(["sweep", str(file), "--scheduler", others(1), "--out", str(tmp_path / "cluster")]) == 0
    assert call(["sweep", str(file), "--workers", "1", "--out", str(tmp_path / "here")]) == 0
    tables = [(tmp_path / place / sample_table.FILE).read_bytes() for place in ("cluster", "here")]
    assert tables[0] == tables[1]
    assert tables[0].count(b"done") == 2


@pytest.mark.thorough
def test_a_second_sweep_leaves_the_cases_of_the_first_alone(tmp_path, others):
    out, address = tmp_path / "out", others(1)
    process = tubes.start(tubes.write(tmp_path), "--scheduler", address, "--out", out, "--set", "stop.time=0.3")
    tubes.wait_for(lambda: list(out.glob("cases/*/run.lock")))
    with cluster.joined(address):
        pass
    said, _ = process.communicate(timeout=300)
    assert process.returncode == 0, said
    assert {case.status for case in hydro2d.open_study(out).cases} == {"done"}


def test_workers_of_several_threads_are_refused(tmp_path, others, capsys):
    assert call(["sweep", str(tubes.write(tmp_path)), "--scheduler", others(2), "--out", str(tmp_path / "out")]) == 2
    assert "has 2 threads; start `dask worker` with --nthreads 1" in capsys.readouterr().err


def test_no_scheduler(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(cluster, "ANSWER", 0.5)
    arguments = ["sweep", str(tubes.write(tmp_path)), "--out", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:9"]
    for _ in range(2):  # the second finds the first one's directory, without a run
        assert call(arguments) == 2
        assert "no scheduler answers" in capsys.readouterr().err


class Fake(distributed.LocalCluster):
    """A SLURM cluster without SLURM."""

    def __init__(self, **arguments):
        type(self).given = arguments
        super().__init__(n_workers=1, threads_per_worker=arguments["cores"] // arguments["processes"], dashboard_address=None)


@pytest.mark.thorough
def test_slurm(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "dask_jobqueue", SimpleNamespace(SLURMCluster=Fake))
    (tmp_path / "job.toml").write_text(JOB)
    arguments = ["--slurm", str(tmp_path / "job.toml"), "--threads", "2", "--workers", "1", "--quiet"]
    assert call(["sweep", str(tubes.write(tmp_path)), "--out", str(tmp_path / "out"), *arguments]) == 0
    assert {case.status for case in hydro2d.open_study(tmp_path / "out").cases} == {"done"}
    prologue = Fake.given.pop("job_script_prologue")
    assert Fake.given == {"cores": 4, "processes": 4, "job_cpu": 8, "memory": "16 GB", "queue": "long"}
    assert "export NUMBA_NUM_THREADS=2" in prologue
    assert prologue[-1] == "module load python"


def test_slurm_arguments_are_those_of_dask_jobqueue():
    """SLURMCluster knows every key that a file may contain."""
    jobqueue = pytest.importorskip("dask_jobqueue")
    every = cluster.Slurm(**{name: _example(field) for name, field in cluster.Slurm.model_fields.items()})
    job = jobqueue.SLURMCluster(**{**every.arguments(1), "interface": "lo"})
    try:
        script = job.job_script()
    finally:
        job.close()
    assert "#SBATCH --cpus-per-task=2" in script
    assert "export NUMBA_NUM_THREADS=1" in script


@pytest.mark.parametrize("folder", ["a b", "it's", '"$HOME"', "`id`; #"])
def test_a_job_script_sets_every_variable_as_it_is(monkeypatch, folder):
    monkeypatch.setenv("HYDRO2D_CACHE_DIR", folder)
    prologue = cluster.Slurm(cores=1, memory="1 GB").arguments(1)["job_script_prologue"]
    script = "\n".join([*prologue, 'printf %s "$HYDRO2D_CACHE_DIR"'])
    assert subprocess.run(["sh", "-c", script], capture_output=True, text=True, check=True).stdout == folder


def _example(field):
    if field.annotation is int:
        return 2
    if "tuple" in str(field.annotation):
        return ["# x"]
    return 60.0 if "float" in str(field.annotation) else "1 GB"


def test_without_dask_jobqueue(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "dask_jobqueue", None)
    (tmp_path / "job.toml").write_text(JOB)
    status = call(["sweep", str(tubes.write(tmp_path)), "--out", str(tmp_path / "out"), "--slurm", str(tmp_path / "job.toml")])
    assert status == 2
    assert "pip install 'hydro2d[slurm]'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("queue", "qeue", 'job.toml:4: qeue: unknown key "qeue"; did you mean "queue"'),
        ("cores = 8", "", "cores: is missing"),
        ("cores = 8", "cores = 0", "job.toml:2: cores: "),
    ],
)
def test_a_wrong_slurm_file(tmp_path, old, new, said):
    (tmp_path / "job.toml").write_text(JOB.replace(old, new, 1))
    with pytest.raises(StudyError) as error:
        cluster.read_slurm(tmp_path / "job.toml")
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--workers", "0"], "a whole number from 1 to 1024"),
        (["--threads", "0"], "a whole number from 1 to 1024"),
        (["--scheduler", "a", "--slurm", "b"], "one of them"),
        (["--scheduler", "a", "--workers", "2"], "one of them"),
        (["--slurm", "none.toml"], "cannot be read"),
    ],
)
def test_arguments(tmp_path, capsys, arguments, said):
    assert call(["sweep", str(tubes.write(tmp_path)), "--out", str(tmp_path / "out"), *arguments]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(("limit", "status"), [((20, 20), 4), ((20, 500), 0)])
def test_few_open_files(tmp_path, limit, status):
    """One line with the remedy, before anything starts; a limit that can be raised is raised."""
    file = tubes.write(tmp_path)
    ended, said = tubes.sweep(file, "--workers", 1, "--out", tmp_path / "out", "--only", "ke_0.1", "--quiet",
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, limit))
    assert ended == status, said
    assert said == ("" if status == 0 else "hydro2d: the workers need 64 open files at a time and the system allows 20; allow "
                    "more with `ulimit -n`\n")


def asked(address) -> bytes:
    """The answer to a request for a page from somebody without the certificate."""
    with socket.create_connection(address, timeout=10) as connection, suppress(ConnectionError):
        connection.sendall(b"GET /sitemap.json HTTP/1.0\r\n\r\n")
        return connection.recv(1000)
    return b""


def test_a_sweep_on_this_machine_listens_to_nobody_else():
    """Neither the scheduler nor a worker can be reached from elsewhere, or without the certificate, and they have no pages."""

    def pages(dask_worker):
        return len(dask_worker.http_application.wildcard_router.rules)

    with cluster.local(1, 1) as client:
        workers = psutil.Process().children(recursive=True)
        places = [
            (process.pid, connection.laddr)
            for process in (psutil.Process(), *workers)
            for connection in process.net_connections("tcp") if connection.status == psutil.CONN_LISTEN
        ]
        assert {address.ip for _, address in places} == {"127.0.0.1"}
        assert len({pid for pid, _ in places}) >= 2
        assert [place for place in places if b"HTTP" in asked(place[1])] == []
        assert {pages(client.cluster.scheduler), *client.run(pages).values()} == {0}
        address = client.scheduler.address
        assert address.startswith("tls://127.0.0.1:")
        with pytest.raises(OSError, match="Timed out|TLS|ssl|closed|Security"):
            distributed.Client(address.replace("tls", "tcp"), timeout=2)
