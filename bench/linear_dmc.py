"""A linear DMC with a target LP (cutler1980, and the two-stage form of industry): step responses, a constant output disturbance, ranked zones and prices at
rest by HiGHS (SciPy), moves by a quadratic programme with limits of inputs and moves. The baseline of targets_study.py."""
import numpy as np
from scipy.optimize import linprog, nnls


def least(hessian, gradient, rows, limits):
    """min x'Hx/2 + g'x with rows x <= limits: the least-distance problem of lawson1974 by NNLS."""
    lower = np.linalg.cholesky(hessian)
    free = -np.linalg.solve(lower.T, np.linalg.solve(lower, gradient))
    room = limits - rows @ free
    if room.min() >= -1e-12:
        return free
    bent = -np.linalg.solve(lower, rows.T)  # z = L'(x - free): bent' z >= -room
    stacked = np.vstack([bent, -room])
    right = np.zeros(len(stacked))
    right[-1] = 1.0
    dual, _ = nnls(stacked, right, maxiter=30 * stacked.shape[1])
    residual = stacked @ dual - right
    if abs(residual[-1]) < 1e-12:
        return free  # no point keeps them all
    return free + np.linalg.solve(lower.T, -residual[:-1] / residual[-1])


class LinearDmc:
    """steps: n_y n_u N, responses to a unit step of each input, sample 1 to N. Zones and input limits as (lower, upper) rows."""

    def __init__(self, steps, zones, inputs, move, price, horizon, moves, move_weight, rest_weight, output_weight, trust):
        self.steps, self.zones, self.inputs, self.move, self.price = steps, np.array(zones, float), np.array(inputs, float), move, np.array(price, float)
        n_y, n_u, self.length = steps.shape
        self.gain, self.trust = steps[:, :, -1], trust
        self.free, self.bias, self.u = np.zeros((n_y, self.length)), np.zeros(n_y), np.zeros(n_u)
        self.horizon, self.moves = horizon, moves
        dynamic = np.zeros((n_y * horizon, n_u * moves))
        for j in range(moves):
            for k in range(j, horizon):
                dynamic[k * n_y:(k + 1) * n_y, j * n_u:(j + 1) * n_u] = steps[:, :, k - j]
        weights = np.tile(np.asarray(output_weight, float), horizon)
        self.weighed = dynamic.T * weights
        whole = np.tile(np.eye(n_u), moves)
        self.hessian = self.weighed @ dynamic + move_weight * np.eye(n_u * moves) + rest_weight * whole.T @ whole
        self.rest_weight, self.whole = rest_weight, whole
        sums = np.kron(np.tril(np.ones((moves, moves))), np.eye(n_u))
        self.rows = np.vstack([np.eye(n_u * moves), -np.eye(n_u * moves), sums, -sums])

    def target(self):
        """The least sum of what is given up, then the least price."""
        offset = self.free[:, -1] + self.bias - self.gain @ self.u
        n_y, n_u = self.gain.shape
        rows = np.vstack([np.hstack([self.gain, -np.eye(n_y)]), np.hstack([-self.gain, -np.eye(n_y)])])
        limits = np.concatenate([self.zones[:, 1] - offset, offset - self.zones[:, 0]])
        kept = np.isfinite(limits)
        bounds = [tuple(b) for b in self.inputs] + [(0, None)] * n_y
        first = linprog(np.r_[np.zeros(n_u), np.ones(n_y)], rows[kept], limits[kept], bounds=bounds, method="highs")
        given = first.x[n_u:] + 1e-9
        second = linprog(np.r_[self.price, np.zeros(n_y)], rows[kept], limits[kept], bounds=bounds[:n_u] + [(0, g) for g in given], method="highs")
        u = (second if second.success else first).x[:n_u]
        return self.gain @ u + offset, u

    def step(self, y):
        self.bias += self.trust * (y - self.free[:, 0] - self.bias)
        target_y, target_u = self.target()
        short = (self.free[:, 1:self.horizon + 1] + self.bias[:, None] - target_y[:, None]).T.ravel()
        gradient = self.weighed @ short + self.rest_weight * self.whole.T @ (self.u - target_u)
        n_u, each = len(self.u), np.tile(np.full(len(self.u), self.move), self.moves)
        limits = np.concatenate([each, each, np.tile(self.inputs[:, 1] - self.u, self.moves), np.tile(self.u - self.inputs[:, 0], self.moves)])
        moved = least(self.hessian, gradient, self.rows, limits)[:n_u]
        u = np.clip(self.u + np.clip(moved, -self.move, self.move), self.inputs[:, 0], self.inputs[:, 1])
        self.free = np.hstack([self.free[:, 1:], self.free[:, -1:]])
        self.free += np.einsum("yuk,u->yk", self.steps, u - self.u)
        self.u = u
        return u
