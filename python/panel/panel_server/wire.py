"""The few messages that come with every sample, read without rospy's objects: a panel beside a fast loop must be cheap.

Layout: msg/*.msg after std_msgs/Header, little endian. Raises struct.error for what is damaged."""
import struct

MOST = 100000  # numbers in one array


def head(buffer):
    """(run_id, step, offset of what follows)."""
    at = 16 + struct.unpack_from("<I", buffer, 12)[0]
    run_id, step = struct.unpack_from("<QI", buffer, at)
    return run_id, step, at + 12


def doubles(buffer, at):
    count = struct.unpack_from("<I", buffer, at)[0]
    if count > MOST:
        raise struct.error(f"an array of {count} numbers")
    return struct.unpack_from(f"<{count}d", buffer, at + 4), at + 4 + 8 * count


def measurement(buffer):
    """(run_id, step, outputs, disturbances, input_applied, final, quality, age, local)."""
    run_id, step, at = head(buffer)
    outputs, at = doubles(buffer, at)
    disturbances, at = doubles(buffer, at)
    applied, at = doubles(buffer, at)
    final, count = struct.unpack_from("<BI", buffer, at)
    quality = tuple(buffer[at + 5:at + 5 + count])
    age, at = doubles(buffer, at + 5 + count)
    return run_id, step, outputs, disturbances, applied, bool(final), quality, age, bool(buffer[at])


def action(buffer):
    """(run_id, step, input, source)."""
    run_id, step, at = head(buffer)
    values, at = doubles(buffer, at)
    return run_id, step, values, buffer[at]


def tracking(buffer):
    """(run_id, step, setpoint, reference)."""
    run_id, step, at = head(buffer)
    setpoint, at = doubles(buffer, at)
    reference, at = doubles(buffer, at)
    return run_id, step, setpoint, reference


def signal(buffer):
    """The number of signal/NAME."""
    return struct.unpack_from("<d", buffer, 16 + struct.unpack_from("<I", buffer, 12)[0])[0]
