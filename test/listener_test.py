#!/usr/bin/python3
"""What a rostest takes for connected, against a publisher that accepts and does not answer."""
import pathlib
import sys
import types
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parent / "ros"))
try:
    import exchange
except ImportError:
    exchange = None


@unittest.skipIf(exchange is None, "built without ROS")
class Listener(unittest.TestCase):
    def publishers(self, *answers):
        """Of a listener whose connections were answered by these nodes; None: not yet."""
        from rospy.impl.tcpros_base import TCPROSTransport, TCPROSTransportProtocol
        connections = []
        for node in answers:
            connection = TCPROSTransport(TCPROSTransportProtocol("topic", None), "topic")
            if node is not None:
                connection.callerid_pub = node
            connections.append(connection)
        listener = exchange.Listener.__new__(exchange.Listener)
        listener.subscriber = types.SimpleNamespace(impl=types.SimpleNamespace(connections=connections))
        return listener.publishers()

    def test_who_has_answered_is_connected(self):
        self.assertEqual(self.publishers("/a", "/b"), {"/a", "/b"})

    def test_who_has_not_answered_is_not(self):
        self.assertFalse(self.publishers(None))
        self.assertEqual(self.publishers(None, "/b"), {"/b"})


if __name__ == "__main__":
    sys.exit(unittest.main())
