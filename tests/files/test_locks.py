"""Locks: one holder at a time, whatever happens to the others."""

import multiprocessing
import os
import signal
import socket
import time

import pytest

from hydro2d.files import locks
from hydro2d.files.locks import LockError, holder, locked
from tests.locks import held


def test_a_lock_says_who_holds_it_and_goes(tmp_path):
    lock = tmp_path / "a.lock"
    with locked(lock):
        assert holder(lock) == (socket.gethostname(), os.getpid())
        with pytest.raises(LockError, match=f"in use by process {os.getpid()} on "), locked(lock):
            pass
        assert holder(lock) is not None
    assert not lock.exists()
    assert holder(lock) is None


def test_a_lock_of_a_dead_process_is_taken_over_even_if_its_number_lives(tmp_path):
    lock = tmp_path / "a.lock"
    lock.write_text(f"{socket.gethostname()} 1")
    assert holder(lock) is None
    with locked(lock):
        assert holder(lock).process == os.getpid()


@pytest.mark.parametrize("text", ["", "nonsense", "a b c", "host x"])
def test_a_lock_that_says_nothing_is_nobodys(tmp_path, text):
    lock = tmp_path / "a.lock"
    lock.write_text(text)
    assert holder(lock) is None
    with locked(lock):
        assert holder(lock) is not None


def test_the_lock_of_another_machine_counts_by_what_it_says(tmp_path):
    lock = tmp_path / "a.lock"
    lock.write_text("elsewhere 7")
    assert holder(lock) == ("elsewhere", 7)
    message = "in use by process 7 on elsewhere; if that process no longer exists, remove "
    with pytest.raises(LockError, match=message), locked(lock):
        pass
    assert lock.read_text() == "elsewhere 7"


def test_one_who_looks_does_not_keep_others_out(tmp_path):
    lock = tmp_path / "a.lock"
    with held(lock):
        assert holder(lock).process == os.getppid()
    with locked(lock):
        pass


def test_a_lock_that_vanishes_while_one_waits_is_taken_anew(tmp_path, monkeypatch):
    """The previous holder removes the file after it was opened here: a lock on a file without a name excludes nobody."""
    lock, take, calls = tmp_path / "a.lock", locks._take_lock, []

    def late(file):
        calls.append(file)
        if len(calls) == 1:
            lock.unlink()
        return take(file)

    monkeypatch.setattr(locks, "_take_lock", late)
    with locked(lock):
        assert lock.exists()
        with pytest.raises(LockError), locked(lock):
            pass


def _race(lock, inside, most, rounds):
    for _ in range(rounds):
        try:
            with locked(lock):
                with inside.get_lock():
                    inside.value += 1
                    most.value = max(most.value, inside.value)
                time.sleep(0.0005)
                with inside.get_lock():
                    inside.value -= 1
        except LockError:
            time.sleep(0.0005)


def test_no_race_has_two_winners(tmp_path):
    """Three processes take and release one lock as fast as they can."""
    spawn = multiprocessing.get_context("spawn")
    lock, inside, most = tmp_path / "a.lock", spawn.Value("i", 0), spawn.Value("i", 0)
    racers = [spawn.Process(target=_race, args=(lock, inside, most, 200)) for _ in range(3)]
    for racer in racers:
        racer.start()
    for racer in racers:
        racer.join(60)
    assert most.value == 1
    assert inside.value == 0


def _hold(lock, ready):
    with locked(lock):
        ready.set()
        time.sleep(60)


def test_a_killed_holder_holds_nothing(tmp_path):
    spawn = multiprocessing.get_context("spawn")
    lock, ready = tmp_path / "a.lock", spawn.Event()
    process = spawn.Process(target=_hold, args=(lock, ready))
    process.start()
    assert ready.wait(30)
    assert holder(lock).process == process.pid
    os.kill(process.pid, signal.SIGKILL)
    process.join(30)
    assert lock.exists()
    assert holder(lock) is None
    with locked(lock):
        pass


def test_without_locks_of_the_system_the_process_that_the_file_names_has_it(tmp_path, monkeypatch):
    """As on Windows: another live process keeps it, a dead one does not, and it goes at the end."""
    monkeypatch.setattr(locks, "fcntl", None)
    lock = tmp_path / "a.lock"
    with locked(lock):
        assert holder(lock) == (socket.gethostname(), os.getpid())
        with pytest.raises(LockError, match=f"in use by process {os.getpid()} on "), locked(lock):
            pass
    assert not lock.exists()
    lock.write_text(f"{socket.gethostname()} {os.getppid()}")
    with pytest.raises(LockError, match=f"in use by process {os.getppid()} on "), locked(lock):
        pass
    ended = multiprocessing.get_context("spawn").Process(target=time.sleep, args=(0,))
    ended.start()
    ended.join()
    lock.write_text(f"{socket.gethostname()} {ended.pid}")
    assert holder(lock) is None
    with locked(lock), locks.turn(tmp_path / "turn"):
        assert holder(lock) is not None
