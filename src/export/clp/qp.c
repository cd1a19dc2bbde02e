/* A dense, strictly convex quadratic programme by the dual active-set method (Goldfarb and Idnani,
 * 1983): from the minimum without limits, violated limits enter the working set one at a time; at
 * most `most` working sets are tried. Its solution is unique, so it does not depend on the path.
 * What is asked and answered: clp_qp_t. The rows are those of clp_row() and clp_rows(). */

#define CLP_NONE 1e30   /* a limit that is none */
#define CLP_EXACT 1e-12 /* a violation that counts, relative to its terms */
#define CLP_SOLVED 1
#define CLP_LIMIT 3
#define CLP_FAILED 4

static double clp_abs(double v) { return (v < 0.0) ? -v : v; }

/* First entry of a row of a lower triangle, or of a column of an upper one. */
static int32_t clp_first(int32_t k) { return (k * (k + 1)) / 2; }

/* v inside 0 to most. It is: a proof needs the words. */
static int32_t clp_within(int32_t v, int32_t most) {
  int32_t to = (v > 0) ? v : 0;
  if (to > most) {
    to = most;
  }
  return to;
}

/* How many constraints the working set holds, and which one is its entry k. */
static int32_t clp_count(const clp_qp_t* q) { return clp_within(q->count, CLP_N); }

static int32_t clp_held(const clp_qp_t* q, int32_t k) {
  return clp_within(q->set[k], (CLP_N + CLP_M) - 1);
}

static double clp_limit(const clp_qp_t* q, int32_t id, int32_t side) {
  double limit;
  if (id < CLP_N) {
    limit = (side > 0) ? q->lower[id] : q->upper[id];
  } else {
    limit = (side > 0) ? q->row_lower[id - CLP_N] : q->row_upper[id - CLP_N];
  }
  return limit;
}

/* R := L with H = L L', then J := L^-T. False where H is not positive definite. */
static bool clp_factor(clp_qp_t* q) {
  bool definite = true;
  for (int32_t i = 0; i < CLP_N; i++) {
    const int32_t row = clp_first(i);
    for (int32_t j = 0; j <= i; j++) {
      const int32_t other = clp_first(j);
      double sum = q->H[row + j];
      for (int32_t k = 0; k < j; k++) {
        sum -= q->R[row + k] * q->R[other + k];
      }
      if (j < i) {
        q->R[row + j] = sum / q->R[other + j];
      } else {
        const double diagonal = q->H[row + i];
        if (!(sum > (1e-14 * diagonal)) || !(sum > 0.0) || !(sum < 1e24)) {
          definite = false;
          sum = 1.0;
        }
        q->R[row + i] = clp_root(sum);
        q->scale[i] = definite ? clp_root(diagonal) : 1.0;
      }
    }
  }
  for (int32_t i = 0; i < CLP_N; i++) {
    double* row = &q->J[i * CLP_N];
    for (int32_t j = 0; j < i; j++) {
      CLP_NO_CALL;
      row[j] = 0.0;
    }
    row[i] = 1.0 / q->R[clp_first(i) + i];
    for (int32_t j = i + 1; j < CLP_N; j++) {
      const double* factor = &q->R[clp_first(j)];
      double sum = 0.0;
      for (int32_t k = i; k < j; k++) {
        sum += factor[k] * row[k];
      }
      row[j] = -sum / factor[j];
    }
  }
  return definite;
}

/* to := J' from, times a sign */
static void clp_transform(const clp_qp_t* q, const double* from, double* to) {
  for (int32_t j = 0; j < CLP_N; j++) {
    CLP_NO_CALL;
    to[j] = 0.0;
  }
  for (int32_t i = 0; i < CLP_N; i++) {
    const double* row = &q->J[i * CLP_N];
    const double value = from[i];
    if (value != 0.0) {
      for (int32_t j = 0; j < CLP_N; j++) {
        to[j] += value * row[j];
      }
    }
  }
}

/* Solves R'v = v and R v = v for the working set. */
static void clp_solve_transposed(const clp_qp_t* q, double* v) {
  const int32_t count = clp_count(q);
  for (int32_t k = 0; k < count; k++) {
    const double* column = &q->R[clp_first(k)];
    double sum = v[k];
    for (int32_t i = 0; i < k; i++) {
      sum -= column[i] * v[i];
    }
    v[k] = sum / column[k];
  }
}

static void clp_solve_upper(const clp_qp_t* q, double* v) {
  for (int32_t k = clp_count(q) - 1; k >= 0; k--) {
    const double* column = &q->R[clp_first(k)];
    v[k] = v[k] / column[k];
    for (int32_t i = 0; i < k; i++) {
      v[i] -= column[i] * v[k];
    }
  }
}

static void clp_measure_rows(clp_t* w) {
  clp_qp_t* q = &w->qp;
  for (int32_t k = 0; k < CLP_M; k++) {
    double size = 0.0;
    double square = 0.0;
    clp_row(w, k, q->normal);
    for (int32_t i = 0; i < CLP_N; i++) {
      const double part = q->normal[i] / q->scale[i];
      size += clp_abs(q->normal[i]);
      square += part * part;
    }
    q->row_size[k] = size;
    q->row_scale[k] = ((square > 1e-24) && (square < 1e24)) ? (1.0 / clp_root(square)) : 0.0;
  }
}

/* The limit outside the working set that is violated most; bounds before rows. -1: none is. */
static int32_t clp_violated(clp_t* w, int32_t* side) {
  clp_qp_t* q = &w->qp;
  int32_t worst = -1;
  double most = 0.0;
  double largest = 0.0;
  for (int32_t i = 0; i < CLP_N; i++) {
    const double size = clp_abs(q->x[i]);
    const double below = q->lower[i] - q->x[i];
    const double above = q->x[i] - q->upper[i];
    const double by = (below > above) ? below : above;
    const double limit = clp_abs((below > above) ? q->lower[i] : q->upper[i]);
    largest = (size > largest) ? size : largest;
    if ((q->side[i] == 0) && ((by * q->scale[i]) > most) &&
        (by > (CLP_EXACT * (limit + 1.0 + size)))) {
      most = by * q->scale[i];
      worst = i;
      *side = (below > above) ? (int32_t)1 : (int32_t)-1;
    }
  }
  if (worst < 0) {
    clp_rows(w, q->x, q->row_value);
    for (int32_t k = 0; k < CLP_M; k++) {
      const double below = q->row_lower[k] - q->row_value[k];
      const double above = q->row_value[k] - q->row_upper[k];
      const double by = (below > above) ? below : above;
      const double limit = clp_abs((below > above) ? q->row_lower[k] : q->row_upper[k]);
      if ((q->side[CLP_N + k] == 0) && ((by * q->row_scale[k]) > most) &&
          (by > (CLP_EXACT * (limit + (q->row_size[k] * (1.0 + largest)))))) {
        most = by * q->row_scale[k];
        worst = CLP_N + k;
        *side = (below > above) ? (int32_t)1 : (int32_t)-1;
      }
    }
  }
  return worst;
}

/* Takes the constraint with transform d and step z into the working set: a reflection of the
 * columns of J that are left. */
static void clp_append(clp_qp_t* q, int32_t id, int32_t side, double norm) {
  const int32_t k = clp_within(q->count, CLP_N - 1);
  double* column = &q->R[clp_first(k)];
  const double first = q->d[k];
  const double pivot = (first > 0.0) ? -norm : norm;
  const double beta = 1.0 / (norm * (norm + clp_abs(first)));
  for (int32_t i = 0; i < k; i++) {
    CLP_NO_CALL;
    column[i] = q->d[i];
  }
  column[k] = pivot;
  q->d[k] = first - pivot;
  for (int32_t i = 0; i < CLP_N; i++) {
    double* row = &q->J[i * CLP_N];
    const double factor = beta * (q->z[i] - (pivot * row[k]));
    for (int32_t j = k; j < CLP_N; j++) {
      row[j] -= factor * q->d[j];
    }
  }
  q->set[k] = id;
  q->side[id] = (int8_t)side;
  q->count = k + 1;
}

/* Takes entry `gone` out of the working set: rotations make R triangular again. */
static void clp_remove(clp_qp_t* q, int32_t gone) {
  const int32_t last = clp_within(q->count - 1, CLP_N - 1);
  q->side[clp_held(q, gone)] = 0;
  for (int32_t k = gone; k < last; k++) {
    const double* from = &q->R[clp_first(k + 1)];
    double* to = &q->R[clp_first(k)];
    double high = from[gone];
    double low;
    double norm;
    for (int32_t i = 0; i < gone; i++) {
      CLP_NO_CALL;
      to[i] = from[i];
    }
    for (int32_t i = gone; i < k; i++) { /* the rotations so far */
      low = from[i + 1];
      to[i] = (q->turn_c[i] * high) + (q->turn_s[i] * low);
      high = (q->turn_c[i] * low) - (q->turn_s[i] * high);
    }
    low = from[k + 1];
    norm = clp_root((high * high) + (low * low));
    if (!(norm > 0.0)) {
      norm = 1.0;
    }
    q->turn_c[k] = high / norm;
    q->turn_s[k] = low / norm;
    to[k] = norm;
    q->set[k] = q->set[k + 1];
    q->y[k] = q->y[k + 1];
  }
  for (int32_t i = 0; i < CLP_N; i++) {
    double* row = &q->J[i * CLP_N];
    for (int32_t k = gone; k < last; k++) {
      const double a = row[k];
      const double b = row[k + 1];
      row[k] = (q->turn_c[k] * a) + (q->turn_s[k] * b);
      row[k + 1] = (q->turn_c[k] * b) - (q->turn_s[k] * a);
    }
  }
  q->count = last;
}

/* normal := that of a constraint; its product with x */
static double clp_take_normal(clp_t* w, int32_t id) {
  clp_qp_t* q = &w->qp;
  double value = 0.0;
  if (id < CLP_N) {
    for (int32_t i = 0; i < CLP_N; i++) {
      CLP_NO_CALL;
      q->normal[i] = 0.0;
    }
    q->normal[id] = 1.0;
    value = q->x[id];
  } else {
    clp_row(w, id - CLP_N, q->normal);
    for (int32_t i = 0; i < CLP_N; i++) {
      value += q->normal[i] * q->x[i];
    }
  }
  return value;
}

/* The entry of the working set whose multiplier first reaches zero as the new one grows; -1: none.
 */
static int32_t clp_blocking(const clp_qp_t* q, bool dependent, double size, double* step) {
  const int32_t count = clp_count(q);
  int32_t first = -1;
  for (int32_t k = 0; k < count; k++) {
    const double rate = q->r[k];
    if (rate > 0.0) {
      const double multiplier = (q->y[k] > 0.0) ? q->y[k] : 0.0;
      const double* column = &q->R[clp_first(k)];
      double square = 0.0;
      for (int32_t i = 0; dependent && (i <= k); i++) {
        square += column[i] * column[i];
      }
      if ((!dependent || ((rate * rate * square) > (1e-24 * size))) &&
          ((first < 0) || ((multiplier / rate) < *step))) {
        *step = multiplier / rate;
        first = k;
      }
    }
  }
  return first;
}

/* Partial steps until the constraint is in the working set, or given up as redundant. */
static int32_t clp_enter(clp_t* w, int32_t id, int32_t side, int32_t most) {
  clp_qp_t* q = &w->qp;
  const double sign = (side > 0) ? 1.0 : -1.0;
  const double limit = clp_limit(q, id, side);
  double entered = 0.0; /* multiplier of the new one */
  int32_t status = CLP_LIMIT;
  bool done = false;
  while (!done && (q->iterations < most)) {
    const int32_t count = clp_count(q);
    const double violation = sign * (limit - clp_take_normal(w, id));
    double head = 0.0;
    double tail = 0.0;
    double step = 0.0;
    double full = 0.0;
    int32_t leaving;
    bool dependent;
    q->iterations++;
    clp_transform(q, q->normal, q->d);
    for (int32_t j = 0; j < CLP_N; j++) {
      q->d[j] = sign * q->d[j];
      q->r[j] = q->d[j];
      if (j < count) {
        head += q->d[j] * q->d[j];
      } else {
        tail += q->d[j] * q->d[j];
      }
    }
    clp_solve_upper(q, q->r);
    dependent = (count >= CLP_N) || !(tail > (1e-20 * (head + tail)));
    leaving = clp_blocking(q, dependent, head + tail, &step);
    if (!(clp_abs(violation) < 1e24) || !((head + tail) < 1e24)) {
      status = CLP_FAILED;
      done = true;
    } else if (dependent && (leaving < 0)) {
      const bool small = violation <= (1e-10 * (clp_abs(limit) + 1.0));
      q->side[id] = 2;
      status = small ? (int32_t)CLP_SOLVED : (int32_t)CLP_FAILED;
      done = true;
    } else {
      if (!dependent) {
        full = ((violation > 0.0) ? violation : 0.0) / tail;
        for (int32_t i = 0; i < CLP_N; i++) {
          const double* row = &q->J[i * CLP_N];
          double sum = 0.0;
          for (int32_t j = count; j < CLP_N; j++) {
            sum += row[j] * q->d[j];
          }
          q->z[i] = sum;
        }
      }
      done = !dependent && ((leaving < 0) || (full <= step));
      if (done) {
        step = full;
      }
      for (int32_t i = 0; (i < CLP_N) && !dependent; i++) {
        q->x[i] += step * q->z[i];
      }
      for (int32_t k = 0; k < count; k++) {
        q->y[k] -= step * q->r[k];
      }
      entered += step;
      if (done && (count < CLP_N)) {
        q->y[count] = entered;
        clp_append(q, id, side, clp_root(tail));
        status = CLP_SOLVED;
      } else if (leaving >= 0) {
        clp_remove(q, leaving);
      } else {
        status = CLP_FAILED;
        done = true;
      }
    }
  }
  return status;
}

/* z := what is left of the gradient, c: of the working set, on the data as given. The multiplier of
 * a bound is what is left there. The largest error, relative to its terms. */
static double clp_errors(clp_t* w) {
  clp_qp_t* q = &w->qp;
  const int32_t count = clp_count(q);
  double worst = 0.0;
  double terms = 1.0;
  for (int32_t k = 0; k < count; k++) {
    const int32_t id = clp_held(q, k);
    if (id < CLP_N) {
      q->x[id] = clp_limit(q, id, q->side[id]);
    }
  }
  for (int32_t i = 0; i < CLP_N; i++) {
    q->z[i] = -q->g[i];
    terms = (clp_abs(q->g[i]) > terms) ? clp_abs(q->g[i]) : terms;
  }
  for (int32_t i = 0; i < CLP_N; i++) {
    const double* row = &q->H[clp_first(i)];
    double sum = row[i] * q->x[i];
    for (int32_t j = 0; j < i; j++) {
      sum += row[j] * q->x[j];
      q->z[j] -= row[j] * q->x[i];
    }
    q->z[i] -= sum;
    terms = (clp_abs(sum) > terms) ? clp_abs(sum) : terms;
  }
  for (int32_t k = 0; k < count; k++) {
    const int32_t id = clp_held(q, k);
    CLP_NO_CALL;
    q->c[k] = 0.0;
    if (id >= CLP_N) {
      const int32_t side = q->side[id];
      const double limit = clp_limit(q, id, side);
      const double value = clp_take_normal(w, id);
      const double y = (side > 0) ? q->y[k] : -q->y[k];
      double size = clp_abs(limit) + 1.0;
      double error;
      for (int32_t i = 0; i < CLP_N; i++) {
        q->z[i] += y * q->normal[i];
        size += clp_abs(q->normal[i] * q->x[i]);
      }
      q->c[k] = limit - value;
      if (side < 0) {
        q->c[k] = -q->c[k];
      }
      error = clp_abs(q->c[k]) / size;
      worst = (error > worst) ? error : worst;
    }
  }
  for (int32_t k = 0; k < count; k++) {
    const int32_t id = clp_held(q, k);
    if (id < CLP_N) {
      q->y[k] = (q->side[id] > 0) ? -q->z[id] : q->z[id];
      q->z[id] = 0.0;
    }
  }
  for (int32_t i = 0; i < CLP_N; i++) {
    const double error = clp_abs(q->z[i]) / terms;
    worst = (error <= worst) ? worst : error;
  }
  return worst;
}

/* H dx - N dy = z, N'dx = c: R'b = c, dx = J [b; J_2'z], R dy = b - J_1'z. */
static void clp_correct(clp_qp_t* q) {
  const int32_t count = clp_count(q);
  clp_transform(q, q->z, q->d);
  clp_solve_transposed(q, q->c);
  for (int32_t k = 0; k < count; k++) {
    q->r[k] = q->c[k] - q->d[k];
    q->d[k] = q->c[k];
  }
  clp_solve_upper(q, q->r);
  for (int32_t k = 0; k < count; k++) {
    q->y[k] += q->r[k];
  }
  for (int32_t i = 0; i < CLP_N; i++) {
    const double* row = &q->J[i * CLP_N];
    double sum = 0.0;
    for (int32_t j = 0; j < CLP_N; j++) {
      sum += row[j] * q->d[j];
    }
    q->x[i] += sum;
  }
}

/* CLP_SOLVED, CLP_LIMIT (more than `most` working sets) or CLP_FAILED (H is not definite, or
 * rounding has won: an error beyond 1e-9 of the terms). */
static int32_t clp_solve(clp_t* w, int32_t most) {
  clp_qp_t* q = &w->qp;
  int32_t status = clp_factor(q) ? (int32_t)CLP_SOLVED : (int32_t)CLP_FAILED;
  bool done = status != CLP_SOLVED;
  q->iterations = 0;
  q->count = 0;
  for (int32_t i = 0; i < (CLP_N + CLP_M); i++) {
    CLP_NO_CALL;
    q->side[i] = 0;
  }
  if (!done) {
    clp_transform(q, q->g, q->d);
    for (int32_t i = 0; i < CLP_N; i++) {
      q->x[i] = 0.0;
      for (int32_t j = i; j < CLP_N; j++) {
        q->x[i] -= q->J[(i * CLP_N) + j] * q->d[j];
      }
    }
    clp_measure_rows(w);
  }
  for (int32_t round = 0; (round < 3) && !done; round++) {
    int32_t side = 0;
    int32_t id = clp_violated(w, &side);
    double error;
    while ((id >= 0) && (status == CLP_SOLVED)) {
      status = clp_enter(w, id, side, most);
      id = clp_violated(w, &side);
    }
    error = clp_errors(w);
    for (int32_t k = 0; k < 3; k++) {
      if (error > 1e-15) {
        clp_correct(q);
        error = clp_errors(w);
      }
    }
    if ((status == CLP_SOLVED) && !(error <= 1e-9)) {
      status = CLP_FAILED;
    }
    done = (status != CLP_SOLVED) || (clp_violated(w, &side) < 0);
  }
  return status;
}
