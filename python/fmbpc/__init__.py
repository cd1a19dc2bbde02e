"""Process control with fuzzy model-based predictive control, for Python users.

    import fmbpc
    run = fmbpc.Loop("reactor_load").run()      # a loop closed in this process
    run.outputs["CA"], run.summary              # numpy arrays with time and unit
    c = fmbpc.Loop("asp_case1").controller()    # the law before a plant of your own
    u = c.step([50.0, 1800.0])                  # of what is measured, in the order of its outputs

Loops and what comes out of them: Loop, loops(), Run with Signal and Event, Controller, Simulation.
Plants and laws: Plant, plants(), controllers(); register(), check(), Quantity for your own.
For learning: env(), an Env or VectorEnv. Models: identify(), Model. Many runs and analyses: study(), tune(), stability(). From a strange plant to a law: commission(). Pictures: fmbpc.plots.
Every computation gives the bits that the tool `fmbpc` and the nodes give. Times are hours unless a
name says otherwise; errors of what you hand over are InputError (a ValueError).
"""
from importlib.util import find_spec as _find_spec

if _find_spec("fmbpc._core") is not None:  # not where only the plots are there: docs/python.md
    from fmbpc import _core
    from fmbpc._control import Controller
    from fmbpc._env import Env, VectorEnv, env
    from fmbpc._loop import Loop, loops
    from fmbpc._model import Model, identify
    from fmbpc._own import Quantity, check, controllers, register
    from fmbpc._plant import Plant, Simulation, plants
    from fmbpc._run import Event, Run, Signal
    from fmbpc._study import commission, stability, study, tune

    InputError = _core.InputError
    InputError.__doc__ = "What was handed over is wrong: the text names it and what was expected (docs/python.md). A ValueError."
    __version__ = _core.version

    __all__ = ["Controller", "Env", "Event", "InputError", "Loop", "Model", "Plant", "Quantity", "Run", "Signal", "Simulation", "VectorEnv",
               "check", "commission", "controllers", "env", "identify", "loops", "plants", "register", "stability", "study", "tune"]
