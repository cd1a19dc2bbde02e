"""What a fault is, and what is asked of the loop while it lasts and after it."""
import dataclasses
import typing

SAID_WITHIN = 2.0     # s of wall time from the fault to its words
PATIENCE = 8.0        # s in which it is looked for at all
RECOVERY = 30.0       # s of wall time in which the loop must be automatic again
SETTLE = 1.5          # s after a kill, so that the word of before is not taken for that of after
SILENCE = 2.0         # s without a sample and without a reported reason: a silent stall


@dataclasses.dataclass
class Fault:
    """`do` and `undo` get the loop under test (Loop).

    `said`: regular expression for a line "NODE WORD: REASON (MISSING)" of loop_state or /diagnostics; None: the loop goes
    on as if nothing had happened and need not say anything. `counted`: (node, start of a counter's name) that must grow.
    `needs`: "optimizer", "simulator", "processes" (of their own), ... of the loop. `touches`: nodes that the fault itself kills.
    `end`: word of the loop's summary afterwards. `after`: a check of its own once the loop is back; returns words if it is not
    content. The name plant_simulator stands for the loop's plant, a gateway too.
    """
    name: str
    do: typing.Callable
    undo: typing.Callable = None
    said: str = None
    counted: tuple = None
    needs: tuple = ()
    touches: tuple = ()
    lasts: float = 0.0          # s of wall time between its words and the undoing
    end: str = "automatic"
    after: typing.Callable = None
    said_within: float = SAID_WITHIN  # s; longer where a process must start first
    new_run: bool = False       # the plant starts a new run
    own_hand: bool = False      # of a gateway's plant: it takes the inputs itself meanwhile
    gap: bool = False           # samples may lack in the record if its summary names them


@dataclasses.dataclass
class Outcome:
    """What was seen."""
    fault: str
    said_after: float = None    # s
    said_words: str = ""
    back_after: int = None      # samples
    largest_move: float = 0.0   # % of the range
    bump: float = 0.0           # % of the range, first move after the input was held or on its fallback
    stood_still: float = 0.0    # s that the machine gave to nobody, the longest
    began: float = 0.0          # s of the steady clock
    ended: float = 0.0
    problems: list = dataclasses.field(default_factory=list)
