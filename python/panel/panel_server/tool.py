"""The command-line tool beside the panel: where it is, what it says of events. Free of ROS."""
import os
import shutil
import subprocess


def tool_path():
    """fmbpc_tool, where scripts/fmbpc finds it."""
    top = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__)))))
    places = [os.path.join(p, "lib/fmbpc/fmbpc_tool") for p in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if p]
    for path in [os.path.join(top, "devel/lib/fmbpc/fmbpc_tool")] + places:
        if os.access(path, os.X_OK):
            return path
    return shutil.which("fmbpc_tool")


def event_list(tool):
    """{code: {severity, cause, consequence, remedy}} of `fmbpc events`; {} without the tool."""
    if not tool:
        return {}
    try:
        text = subprocess.run([tool, "events"], check=True, timeout=20, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    except (OSError, subprocess.SubprocessError):
        return {}
    found = {}
    for line in text.splitlines():
        cells = [c.strip() for c in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 5:
            found[cells[0].strip("`")] = dict(zip(("severity", "cause", "consequence", "remedy"), cells[1:]))
    return found
