"""A forked process: the threads of its parent stayed behind, and it works all the same."""

import multiprocessing

import pytest

import bench
import rotor_hhc


def identified():
    return rotor_hhc.identify(bench.runs(), model="static-preisach", flap_deg_per_um=0.04)


def child(answers):
    answers.put(identified().model)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no forks here")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_finds_the_same():
    # begins the threads for parallel work
    here = identified().model
    context = multiprocessing.get_context("fork")
    answers = context.SimpleQueue()
    process = context.Process(target=child, args=(answers,), daemon=True)
    process.start()
    process.join(300.0)
    is_stuck = process.is_alive()
    process.kill()
    assert not is_stuck, "the forked process waits for threads that it does not have"
    assert process.exitcode == 0
    assert answers.get() == here
