#!/usr/bin/python3
"""Node panel: the operator's panel in a browser, for all loops of a master (docs/panel.md).

  rosrun fmbpc panel.py _port:=8080            view only, on this machine: http://localhost:8080
  panel.py --add-user NAME view|operate|engineer [--token]   asks for a password, or makes a token, and keeps its hash
  panel.py --users FILE ...                    another file of users than ~/.ros/fmbpc/panel/users.json

Parameters: ~address (127.0.0.1), ~port (8080), ~users, ~data (folder of the journal), ~loops (namespaces; all), ~hosts (names by which a
reverse proxy calls it), ~https (the proxy speaks TLS), ~history_mb (100), ~open (on an address of the network, who has not logged in sees too).
"""
import argparse
import getpass
import os
import secrets
import signal
import sys
import threading

if {"-h", "--help"} & set(sys.argv[1:]):  # without ROS as well
    print(__doc__.strip())
    sys.exit(0)

# Debian 11's rospy calls Thread.isAlive, which its Python has no more.
if not hasattr(threading.Thread, "isAlive"):
    threading.Thread.isAlive = threading.Thread.is_alive

sys.path.insert(0, next(p for p in (os.path.join(os.path.dirname(os.path.realpath(__file__)), *way, "panel")
                                    for way in (("..", "python"), ("..", "..", "share", "fmbpc", "python"))) if os.path.isdir(p)))

from panel_server import access  # noqa: E402

NICE = 10  # the loops come first
LOOPBACK = ("127.0.0.1", "::1", "localhost")


def home():
    return os.path.join(os.environ.get("ROS_HOME") or os.path.expanduser("~/.ros"), "fmbpc", "panel")


def add_user(arguments):
    path = arguments.users or os.path.join(home(), "users.json")
    name, role = arguments.add_user
    if arguments.token:
        secret = secrets.token_urlsafe(32)
        access.write_user(path, name, role, token=secret)
        print(secret)
        return
    secret = getpass.getpass(f"password of {name}: ") if sys.stdin.isatty() else sys.stdin.readline().rstrip("\n")
    if sys.stdin.isatty() and getpass.getpass("again: ") != secret:
        raise access.AccessError("password: expected the same one twice")
    access.write_user(path, name, role, password=secret)
    print(f"{path}: {name} may {role}")


def main():
    import rospy  # noqa: PLC0415: --add-user works without ROS
    import tornado.ioloop

    from panel_server import web

    os.nice(NICE)
    rospy.init_node("panel", disable_signals=True)
    get = rospy.get_param
    address, port = str(get("~address", "127.0.0.1")), int(get("~port", 8080))
    users = access.read_users(str(get("~users", "")) or os.path.join(home(), "users.json"))
    near = address in LOOPBACK
    anonymous = "view" if near or get("~open", False) else "none"
    if not near and not users and anonymous == "none":
        raise access.AccessError(f"~address {address}: expected users (panel.py --add-user) before others than this machine may connect")
    panel = web.Panel(str(get("~data", "")) or home(), access.Access(users, anonymous), only=list(get("~loops", [])), history_mb=float(get("~history_mb", 100.0)))
    _, port = web.serve(panel, address, port, hosts=list(get("~hosts", [])), secure=bool(get("~https", False)), anonymous=anonymous)
    rospy.set_param("~listening", port)
    who = f"{len(users)} users" if users else "view only: no users (panel.py --add-user)"
    rospy.loginfo("panel: http://%s:%d, %s", "localhost" if near else address, port, who)
    loop = tornado.ioloop.IOLoop.current()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: loop.add_callback_from_signal(loop.stop))
    rospy.on_shutdown(lambda: loop.add_callback(loop.stop))
    loop.start()
    panel.close()
    rospy.signal_shutdown("the panel was ended")
    os._exit(0)


if __name__ == "__main__":
    try:
        if "--add-user" in sys.argv:
            parser = argparse.ArgumentParser(prog="panel.py")
            parser.add_argument("--add-user", nargs=2, metavar=("NAME", "ROLE"))
            parser.add_argument("--token", action="store_true")
            parser.add_argument("--users", default="")
            add_user(parser.parse_args())
        else:
            main()
    except Exception as error:  # noqa: BLE001: one line says what is wrong
        if type(error).__name__ not in ("AccessError", "StartError"):
            raise
        sys.exit(f"fmbpc: panel: {error}")
