"""Who may do what: users with roles and hashed passwords, tokens, sessions, limits of rates, and what a request must look like."""
import hashlib
import hmac
import json
import os
import secrets
import stat
import threading
import time

ROLES = ("none", "view", "operate", "engineer")   # each may what those before it may
SCRYPT = {"n": 2 ** 14, "r": 8, "p": 1}
IDLE = 3600.0          # s, then a session ends
LONGEST = 12 * 3600.0  # s
MOST_SESSIONS = 200
LEAST_PASSWORD = 10    # characters


class AccessError(Exception):
    """One line that says what is wrong with the file of users."""


def rank(role):
    return ROLES.index(role)


def hashed(secret):
    """scrypt$SALT$KEY, in hex."""
    salt = secrets.token_bytes(16)
    return f"scrypt${salt.hex()}${hashlib.scrypt(secret.encode(), salt=salt, **SCRYPT).hex()}"


def fits(secret, stored):
    try:
        kind, salt, key = stored.split("$")
        if kind != "scrypt":
            return False
        return hmac.compare_digest(hashlib.scrypt(secret.encode(), salt=bytes.fromhex(salt), **SCRYPT).hex(), key)
    except (ValueError, AttributeError):
        return False


NOBODY = hashed(secrets.token_hex(16))  # an unknown name takes as long as a wrong password


def read_users(path):
    """{name: {"role", "password" (hash) and/or "token" (hash)}} of a JSON file that only its owner may read; {} without one.

    Raises AccessError naming file, key and what was expected."""
    try:
        with open(path, encoding="utf-8") as stream:
            mode = os.fstat(stream.fileno()).st_mode
            users = json.load(stream)
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise AccessError(f"{path}: expected a JSON file of users ({error})") from error
    if mode & (stat.S_IRWXG | stat.S_IRWXO):
        raise AccessError(f"{path}: expected a file that only its owner may read (chmod 600)")
    if not isinstance(users, dict):
        raise AccessError(f"{path}: expected an object of users")
    for name, user in users.items():
        if not isinstance(user, dict) or user.get("role") not in ROLES[1:]:
            raise AccessError(f"{path}: {name}: role: expected one of {', '.join(ROLES[1:])}")
        given = [key for key in ("password", "token") if key in user]
        if not given or any(not str(user[key]).startswith("scrypt$") for key in given):
            raise AccessError(f"{path}: {name}: expected the hash of a password or a token (panel.py --add-user)")
    return users


def write_user(path, name, role, **given):
    """Adds or changes one user; given: password or token, in plain text."""
    if role not in ROLES[1:]:
        raise AccessError(f"role: expected one of {', '.join(ROLES[1:])}, got '{role}'")
    for secret in given.values():
        if len(secret) < LEAST_PASSWORD:
            raise AccessError(f"password: expected at least {LEAST_PASSWORD} characters")
    users = read_users(path)
    users[name] = {"role": role, **{key: hashed(secret) for key, secret in given.items()}}
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    handle = os.open(path + ".part", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(handle, "w", encoding="utf-8") as stream:
        json.dump(users, stream, indent=1, sort_keys=True)
    os.replace(path + ".part", path)


class Bucket:
    """No more than `burst` at once and `per_s` on the average, for each key; the keys are bounded."""

    def __init__(self, per_s, burst, most=4096):
        self.per_s, self.burst, self.most, self.left = per_s, burst, most, {}
        self.lock = threading.Lock()

    def take(self, key, now=None):
        now = time.monotonic() if now is None else now
        with self.lock:
            left, last = self.left.pop(key, (self.burst, now))
            left = min(self.burst, left + (now - last) * self.per_s)
            passes = left >= 1.0
            self.left[key] = (left - 1.0 if passes else left, now)  # the newest last
            while len(self.left) > self.most:
                self.left.pop(next(iter(self.left)))
            return passes

    def give_back(self, key):
        with self.lock:
            if key in self.left:
                left, last = self.left[key]
                self.left[key] = (min(self.burst, left + 1.0), last)


class Session:
    def __init__(self, name, role, now):
        self.name, self.role, self.began, self.used = name, role, now, now
        self.xsrf = secrets.token_urlsafe(24)


class Access:
    """Logins, sessions and tokens. Anonymous is who shows neither; `anonymous`: its role."""

    def __init__(self, users, anonymous="view", clock=time.monotonic):
        self.users, self.anonymous, self.clock = users, anonymous, clock
        self.sessions, self.lock = {}, threading.Lock()
        self.tries = Bucket(per_s=1.0 / 12.0, burst=5)  # logins: wrong ones by address, all by name
        self.seen_tokens = {}                           # digest of a token that fitted: name, so that scrypt runs once

    def login(self, name, password, address):
        """(id of a session, why not)."""
        if not (isinstance(name, str) and isinstance(password, str) and len(name) <= 64 and len(password) <= 256):
            return None, "expected a name and a password"
        if not (self.tries.take(("address", address), self.clock()) and self.tries.take(("name", name), self.clock())):
            return None, "too many tries: wait a minute"
        user = self.users.get(name, {})
        right = fits(password, user.get("password", NOBODY))
        if not right or "password" not in user:
            return None, "name or password is wrong"
        self.tries.give_back(("address", address))
        key, now = secrets.token_urlsafe(32), self.clock()
        with self.lock:
            self._sweep(now)
            while len(self.sessions) >= MOST_SESSIONS:
                self.sessions.pop(min(self.sessions, key=lambda k: self.sessions[k].used))
            self.sessions[key] = Session(name, user["role"], now)
        return key, ""

    def _sweep(self, now):
        for key in [k for k, s in self.sessions.items() if now - s.used > IDLE or now - s.began > LONGEST]:
            del self.sessions[key]

    def session(self, key):
        if not key:
            return None
        with self.lock:
            now = self.clock()
            self._sweep(now)
            found = self.sessions.get(key)
            if found:
                found.used = now
            return found

    def logout(self, key):
        with self.lock:
            self.sessions.pop(key, None)

    def token(self, token, address):
        """(name, role) of a token, or None."""
        if not token or len(token) > 256:
            return None
        digest = hashlib.sha256(token.encode()).hexdigest()
        name = self.seen_tokens.get(digest)
        if name is None:
            if not self.tries.take(("token", address), self.clock()):
                return None
            name = next((n for n, user in self.users.items() if "token" in user and fits(token, user["token"])), None)
            if name is None:
                return None
            self.seen_tokens[digest] = name
        return name, self.users[name]["role"]


class Caller:
    """Who asks, and with what role."""

    def __init__(self, name, role, session=None, by_token=False):
        self.name, self.role, self.session, self.by_token = name, role, session, by_token

    def may(self, role):
        return rank(self.role) >= rank(role)


def allowed_hosts(address, port, more=()):
    """What the header Host may be: no name of a stranger's (DNS rebinding)."""
    names = {"localhost", "127.0.0.1", "[::1]"}
    if address not in ("0.0.0.0", "::", ""):
        names.add(f"[{address}]" if ":" in address else address)
    hosts = {f"{name}:{port}" for name in names}
    if port in (80, 443):
        hosts |= names
    return hosts | set(more)


def judge(method, host, origin, kind, fetch_site, xsrf, caller, hosts):
    """Why a request that changes something is refused; "" if it may go on. The role is judged by the command."""
    if method != "POST":
        return "method: expected POST"
    if host not in hosts:
        return "host: not an address of this panel"
    if origin is not None and origin.partition("://")[2] != host:
        return "origin: another page may not do this"
    if origin is None and not caller.by_token:
        return "origin: missing"
    if fetch_site not in (None, "same-origin", "none"):
        return "origin: another site may not do this"
    if (kind or "").partition(";")[0].strip().lower() != "application/json":
        return "content type: expected application/json"
    if caller.session is not None and not hmac.compare_digest(str(xsrf or "").encode(), caller.session.xsrf.encode()):
        return "token of the page: missing or wrong"
    return ""
