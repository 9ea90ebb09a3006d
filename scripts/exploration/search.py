"""Searches a sweep's designs with Optuna instead of running them all: search.py SWEEP PROGRAM STORE STORAGE RUNS NUMBER.

Several workers share a study. A design that has a result already is not run again, and does not count.
"""
import sys
import warnings
from pathlib import Path

import optuna

from plan import Planner
from run_job import perform
from store import Store
from sweep_file import read_sweep
from table import costs, measured

# Storage in a file and the sampler's options below are experimental in Optuna 3.1.
warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
optuna.logging.set_verbosity(optuna.logging.WARNING)


def open_study(planner, storage, number):
    sweep = planner.sweep
    if "://" not in storage:
        # An append-only file: works on network file systems, too.
        storage = optuna.storages.JournalStorage(optuna.storages.JournalFileStorage(storage))
    # Every worker samples different designs.
    sampler = optuna.samplers.TPESampler(seed=sweep.search["seed"] + number, multivariate=True, constant_liar=True,
                                         n_startup_trials=max(10, 2 * len(sweep.axes)))
    # Another program, sweep file or input is a separate study, since its designs have other results.
    name = f"{sweep.name} {planner.hash.address(planner.content())}"
    return optuna.create_study(study_name=name, storage=storage, load_if_exists=True, sampler=sampler,
                               directions=["minimize"] * len(sweep.objectives))


def designs_of(study, finished=True):
    """{key: (scene, positions)} of the evaluated designs."""
    taken = [trial.user_attrs["design"] for trial in study.get_trials(deepcopy=False)
             if "design" in trial.user_attrs and "skipped" not in trial.user_attrs
             and (trial.state.is_finished() or not finished)]
    return {key: (scene, tuple(positions)) for key, scene, positions in taken}


def release(study):
    """Fails trials that killed workers left unfinished."""
    for trial in study.get_trials(deepcopy=False):
        if not trial.state.is_finished():
            study.tell(trial.number, state=optuna.trial.TrialState.FAIL)


def positions_of(trial, sweep):
    """Positions on the axes. Numbers are ordered, words are not."""
    positions = []
    for index, axis in enumerate(sweep.axes):
        ordered = all(isinstance(point.cells[0], (int, float)) for point in axis.points) and len(axis.columns) == 1
        name, last = f"{index} {axis.columns[0]}", len(axis.points) - 1
        positions.append(trial.suggest_int(name, 0, last) if ordered else
                         trial.suggest_categorical(name, list(range(last + 1))))
    return tuple(positions)


def run_trial(study, planner, store, runs):
    sweep, trial = planner.sweep, study.ask()
    give_up = optuna.trial.TrialState.FAIL
    scenes = list(sweep.scenes)
    scene = scenes[0] if len(scenes) == 1 else trial.suggest_categorical("scene", scenes)
    positions = positions_of(trial, sweep)
    design = planner.complete(planner.design(planner.number(scene, positions), scene, positions))
    if design is None or design.refused:
        study.tell(trial, state=give_up)
        return
    trial.set_user_attr("design", [design.key, scene, positions])
    if len(designs_of(study, finished=False)) > runs:
        trial.set_user_attr("skipped", True)
        study.tell(trial, state=give_up)
        return
    found = None
    if store.has(design.key) or perform(store, planner.task(design), sweep.longest_run):
        result = store.read(design.key)
        if result["exit_code"] == 0:
            found = costs(sweep, measured(sweep, result)[0])
    study.tell(trial, found, state=None if found else give_up)


def main():
    path, program, folder, storage, runs, number = sys.argv[1:]
    sweep = read_sweep(Path(path))
    planner, store = Planner(sweep, Path(program)), Store(folder)
    study = open_study(planner, storage, int(number))
    # Trials in progress count, so that all workers together stop at the number. Few new designs may remain.
    while len(designs_of(study, finished=False)) < int(runs) and len(study.get_trials(deepcopy=False)) < 5 * int(runs):
        run_trial(study, planner, store, int(runs))
    return 0


if __name__ == "__main__":
    sys.exit(main())
