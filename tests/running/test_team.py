"""A run uses the fastest number of threads, and notices when that changes."""

from hydro2d.running.team import TRIAL, Team


class Machine:
    """Seconds of a cycle by number of threads; its clock advances by them."""

    def __init__(self, most, costs):
        self.now, self.threads, self.costs = 0.0, most, costs
        self.team = Team(most, self.use, lambda: self.now)

    def use(self, threads):
        self.threads = threads

    def cycle(self):
        self.now += self.costs(self.threads, self.now)
        return 1

    def run(self, cycles):
        begun = self.now
        for _ in range(cycles):
            self.team.run(self.cycle)
        return self.now - begun


def test_all_threads_where_they_are_faster():
    machine = Machine(2, lambda threads, now: 0.006 / threads)
    spent = machine.run(5000)
    assert machine.threads == 2
    assert spent < 1.06 * 5000 * 0.003
    assert machine.team.cycles[2] > 0.9 * 5000


def test_one_thread_where_another_process_holds_the_second_core():
    machine = Machine(2, lambda threads, now: 0.006 if threads == 1 else 0.06)
    spent = machine.run(5000)
    assert machine.threads == 1
    assert spent < 1.1 * 5000 * 0.006


def test_the_best_number_is_found_again_when_it_changes():
    """From 20 s to 60 s the second core is busy: a second after each change the number is right again."""
    machine = Machine(2, lambda threads, now: 0.006 if threads == 1 else (0.06 if 20.0 <= now < 60.0 else 0.003))
    while machine.now < 20.0:
        machine.run(1)
    assert machine.threads == 2
    while machine.now < 22.5:
        machine.run(1)
    assert machine.threads == 1
    while machine.now < 60.0 + 20.0 * TRIAL * 0.066 + 1.0:
        machine.run(1)
    assert machine.threads == 2


def test_a_half_of_the_threads_may_be_best():
    costs = {8: 0.004, 4: 0.002, 2: 0.003, 1: 0.006}
    machine = Machine(8, lambda threads, now: costs[threads])
    machine.run(100)
    assert machine.threads == 4


def test_a_run_on_one_thread_tries_nothing():
    machine = Machine(1, lambda threads, now: 0.01)
    machine.run(100)
    assert machine.team.cycles == {1: 100}
    assert machine.team.thread_use() == ""


def test_the_log_says_what_was_used():
    machine = Machine(2, lambda threads, now: 0.006 if threads == 1 else 0.06)
    assert machine.team.thread_use() == ""
    machine.run(100)
    assert machine.team.thread_use() == "1 thread in 95 % of the cycles, 2 in 5 %"


def test_in_the_end_all_threads_are_free_again():
    machine = Machine(2, lambda threads, now: 0.006 if threads == 1 else 0.06)
    machine.run(100)
    machine.team.all()
    assert machine.threads == 2
