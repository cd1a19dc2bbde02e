"""Pictures of what fmbpc found: run, model, stability, study, tuning, commissioning, reproduction, bsm1.

    python3 -m fmbpc.plots KIND DIR [DIR ...]        as the tool draws them; KIND --help
    fmbpc.plots.run_picture([run, other])            a matplotlib figure of runs or their folders
"""
from fmbpc.plots.table import read_table

KINDS = ("run", "model", "stability", "study", "tuning", "commissioning", "reproduce", "bsm1")

__all__ = ["KINDS", "read_table", "run_picture"]


def run_picture(runs):
    """One run with setpoints, references, limits and disturbances, or several compared; a list of fmbpc.Run or of folders.

    Returns a matplotlib figure. Raises OSError for a folder without a run (docs/operation.md).
    """
    from fmbpc.plots import run
    return run.picture([run.Run.of(r) for r in runs])
