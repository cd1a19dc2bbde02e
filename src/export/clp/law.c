/* The closed-loop paradigm: the perturbations of the base law over CLP_NC samples that cost least
 * inside the limits, the local model frozen. Unknowns are the inputs' distances from the base law
 * rolled out, over clp_unit, then one slack for each output with soft limits. */

#define CLP_UNLIMITED 1e12
#define CLP_NEGLIGIBLE 1e-6 /* of an input's unit: no actuator shows less */

static void clp_row(const clp_t* w, int32_t row, double* to);
static void clp_rows(const clp_t* w, const double* x, double* to);

#include "qp.c"

static double clp_bounded(double v, double low, double high) {
  double to = v;
  if (to < low) {
    to = low;
  }
  if (to > high) {
    to = high;
  }
  return to;
}

static double clp_power_of_two(double v) {
  double to = 1.0;
  if ((v > 0.0) && (v < 1e300)) {
    for (int32_t i = 0; i < 1000; i++) {
      if (v >= (to * 1.4142135623730951)) {
        to = to * 2.0;
      } else if (v < (to * 0.7071067811865476)) {
        to = to * 0.5;
      } else {
        break;
      }
    }
  }
  return to;
}

/* next := A x + B u, and g where `affine` */
static void clp_advance(const clp_t* w, const double* x, const double* u, bool affine,
                        double* next) {
  for (int32_t i = 0; i < CLP_NX; i++) {
    const int32_t kind = clp_kind[i];
    double to = 0.0;
    if (kind < CLP_NY) {
      to = affine ? w->g[kind] : 0.0;
      for (int32_t j = 0; j < CLP_NX; j++) {
        to += w->A[(kind * CLP_NX) + j] * x[j];
      }
      for (int32_t j = 0; j < CLP_NU; j++) {
        to += w->B[(kind * CLP_NU) + j] * u[j];
      }
    } else if (kind == CLP_NY) {
      to = (i > 0) ? x[i - 1] : 0.0;
    } else if (kind <= (CLP_NY + CLP_NU)) {
      to = u[kind - CLP_NY - 1];
    } else {
      to = affine ? w->d[kind - CLP_NY - CLP_NU - 1] : 0.0;
    }
    next[i] = to;
  }
}

static void clp_copy(const double* from, double* to, int32_t count) {
  for (int32_t i = 0; i < count; i++) {
    CLP_NO_CALL;
    to[i] = from[i];
  }
}

#if CLP_TARGET
/* aim_x, aim_u: where the local model would hold the chosen outputs at their setpoints, from
 * [A - I, B; C, 0] [x; u] = [-g; setpoint - offset] with full pivoting. False: not unique. */
static bool clp_find_target(clp_t* w) {
  const int32_t n = CLP_NX + CLP_NU;
  double largest = 0.0;
  bool unique = true;
  for (int32_t i = 0; i < (n * n); i++) {
    CLP_NO_CALL;
    w->system[i] = 0.0;
  }
  for (int32_t j = 0; j < n; j++) { /* column by column: what moves with each unknown */
    double unit[CLP_NU];
    for (int32_t i = 0; i < CLP_NX; i++) {
      w->state[i] = (i == j) ? 1.0 : 0.0;
    }
    for (int32_t i = 0; i < CLP_NU; i++) {
      unit[i] = ((CLP_NX + i) == j) ? 1.0 : 0.0;
    }
    clp_advance(w, w->state, unit, false, w->next);
    for (int32_t i = 0; i < CLP_NX; i++) {
      w->system[(i * n) + j] = w->next[i] - w->state[i];
    }
    for (int32_t i = 0; i < CLP_NU; i++) {
      w->system[((CLP_NX + i) * n) + j] = (j == clp_output_row[clp_target[i]]) ? 1.0 : 0.0;
    }
    w->order[j] = j;
  }
  for (int32_t i = 0; i < CLP_NX; i++) {
    const int32_t kind = clp_kind[i];
    w->right[i] = 0.0;
    if (kind < CLP_NY) {
      w->right[i] = -w->g[kind];
    }
    if (kind > (CLP_NY + CLP_NU)) {
      w->right[i] = -w->d[kind - CLP_NY - CLP_NU - 1];
    }
  }
  for (int32_t i = 0; i < CLP_NU; i++) {
    const int32_t output = clp_target[i];
    w->right[CLP_NX + i] = w->setpoint[output] - w->offset[output];
  }
  for (int32_t k = 0; k < n; k++) {
    int32_t row = k;
    int32_t column = k;
    double pivot;
    for (int32_t i = k; i < n; i++) {
      for (int32_t j = k; j < n; j++) {
        if (clp_abs(w->system[(i * n) + j]) > clp_abs(w->system[(row * n) + column])) {
          row = i;
          column = j;
        }
      }
    }
    for (int32_t j = 0; j < n; j++) {
      const double kept = w->system[(row * n) + j];
      w->system[(row * n) + j] = w->system[(k * n) + j];
      w->system[(k * n) + j] = kept;
    }
    for (int32_t i = 0; i < n; i++) {
      const double kept = w->system[(i * n) + column];
      w->system[(i * n) + column] = w->system[(i * n) + k];
      w->system[(i * n) + k] = kept;
    }
    {
      const double kept = w->right[row];
      const int32_t place = w->order[column];
      w->right[row] = w->right[k];
      w->right[k] = kept;
      w->order[column] = w->order[k];
      w->order[k] = place;
    }
    pivot = w->system[(k * n) + k];
    largest = (clp_abs(pivot) > largest) ? clp_abs(pivot) : largest;
    if (!(clp_abs(pivot) > (largest * 2.220446049250313e-16 * (double)n))) {
      unique = false;
      pivot = 1.0;
    }
    for (int32_t i = k + 1; i < n; i++) {
      const double factor = w->system[(i * n) + k] / pivot;
      for (int32_t j = k + 1; j < n; j++) {
        w->system[(i * n) + j] -= factor * w->system[(k * n) + j];
      }
      w->right[i] -= factor * w->right[k];
    }
  }
  for (int32_t k = n - 1; k >= 0; k--) {
    const int32_t place = w->order[k];
    for (int32_t j = k + 1; j < n; j++) {
      w->right[k] -= w->system[(k * n) + j] * w->right[j];
    }
    w->right[k] = unique ? (w->right[k] / w->system[(k * n) + k]) : 0.0;
    if (place < CLP_NX) {
      w->aim_x[place] = w->right[k];
    } else {
      w->aim_u[place - CLP_NX] = w->right[k];
    }
  }
  return unique;
}
#endif

#if CLP_LQ
/* to := a b, or a' b */
static void clp_multiply(const double* a, const double* b, bool transposed, double* to) {
  for (int32_t i = 0; i < CLP_NX; i++) {
    for (int32_t j = 0; j < CLP_NX; j++) {
      double sum = 0.0;
      for (int32_t k = 0; k < CLP_NX; k++) {
        sum += (transposed ? a[(k * CLP_NX) + i] : a[(i * CLP_NX) + k]) * b[(k * CLP_NX) + j];
      }
      to[(i * CLP_NX) + j] = sum;
    }
  }
}

/* weight := sum of Phi'^k (Phi' Q Phi + K' R K) Phi^k, Phi = A - B K, by doubling. False: it is not
 * stable. */
static bool clp_weigh_end(clp_t* w) {
  bool sane = true;
  bool vanished = false;
  for (int32_t j = 0; j < CLP_NX; j++) { /* power := Phi, column by column */
    double input[CLP_NU];
    for (int32_t i = 0; i < CLP_NX; i++) {
      w->state[i] = (i == j) ? 1.0 : 0.0;
    }
    for (int32_t a = 0; a < CLP_NU; a++) {
      input[a] = -w->K[(a * CLP_NX) + j];
    }
    clp_advance(w, w->state, input, false, w->next);
    for (int32_t i = 0; i < CLP_NX; i++) {
      w->power[(i * CLP_NX) + j] = w->next[i];
    }
  }
  for (int32_t i = 0; i < CLP_NX; i++) {
    for (int32_t j = 0; j < CLP_NX; j++) {
      double sum = 0.0;
      for (int32_t o = 0; o < CLP_NY; o++) {
        const int32_t row = clp_output_row[o] * CLP_NX;
        sum += clp_weight_output[o] * w->power[row + i] * w->power[row + j];
      }
      for (int32_t a = 0; a < CLP_NU; a++) {
        sum += clp_weight_input[a] * w->K[(a * CLP_NX) + i] * w->K[(a * CLP_NX) + j];
      }
      w->weight[(i * CLP_NX) + j] = sum;
    }
  }
  for (int32_t doubling = 0; (doubling < 60) && sane && !vanished; doubling++) {
    double size = 0.0;
    for (int32_t i = 0; i < (CLP_NX * CLP_NX); i++) {
      size += w->power[i] * w->power[i];
    }
    sane = size < 1e200;
    if (sane) {
      vanished = size < 1e-60;
      clp_multiply(w->weight, w->power, false, w->product);
      clp_multiply(w->power, w->product, true, w->square);
      for (int32_t i = 0; i < (CLP_NX * CLP_NX); i++) {
        w->weight[i] += w->square[i];
      }
      clp_multiply(w->power, w->power, false, w->square);
      clp_copy(w->square, w->power, CLP_NX * CLP_NX);
    }
  }
  return sane && vanished;
}
#endif

/* plan_u, plan_y: the base law over the horizon. */
static void clp_roll_out(clp_t* w) {
  double input[CLP_NU];
  double start[CLP_NU];
  double left = 1.0; /* share of the bias */
  double share[CLP_NY];
  clp_copy(w->x, w->state, CLP_NX);
  for (int32_t o = 0; o < CLP_NY; o++) {
    share[o] = 1.0;
  }
  for (int32_t a = 0; a < CLP_NU; a++) {
    start[a] = w->base[a];
    for (int32_t j = 0; j < CLP_NX; j++) {
      start[a] += w->K[(a * CLP_NX) + j] * w->x[j];
    }
  }
  for (int32_t i = 0; i < CLP_NC; i++) {
    for (int32_t a = 0; a < CLP_NU; a++) {
      double to = start[a] + ((left - 1.0) * w->bias[a]);
      for (int32_t o = 0; o < CLP_NY; o++) {
        to += w->L[(a * CLP_NY) + o] * (share[o] - 1.0) * w->away[o];
      }
      for (int32_t j = 0; j < CLP_NX; j++) {
        to -= w->K[(a * CLP_NX) + j] * w->state[j];
      }
      input[a] = (i == 0) ? w->base[a] : to;
      w->plan_u[(i * CLP_NU) + a] = input[a];
    }
    clp_advance(w, w->state, input, true, w->next);
    clp_copy(w->next, w->state, CLP_NX);
    for (int32_t o = 0; o < CLP_NY; o++) {
      w->plan_y[(i * CLP_NY) + o] = w->state[clp_output_row[o]] + w->offset[o];
      share[o] = share[o] * clp_pole[o];
    }
    left = left * CLP_DECAY;
  }
}

/* Limits of this sample. The first move is folded into the bounds of u(k), where the bound wins. */
static void clp_set_limits(clp_t* w) {
  for (int32_t a = 0; a < CLP_NU; a++) {
#if CLP_INCREMENTAL
    w->low[a] = w->aim_u[a] + clp_increment_lower[a];
    w->high[a] = w->aim_u[a] + clp_increment_upper[a];
    w->low_now[a] = w->low[a];
    w->high_now[a] = w->high[a];
#else
    w->low[a] = w->lower[a];
    w->high[a] = w->upper[a];
    w->low_now[a] = w->low[a];
    w->high_now[a] = w->high[a];
    if (w->move[a] < CLP_UNLIMITED) {
      w->low_now[a] = clp_bounded(w->previous[a] - w->move[a], w->low[a], w->high[a]);
      w->high_now[a] = clp_bounded(w->previous[a] + w->move[a], w->low[a], w->high[a]);
    }
#endif
    {
      const double least = clp_bounded(w->least[a], w->low_now[a], w->high_now[a]);
      w->high_now[a] = clp_bounded(w->most[a], least, w->high_now[a]);
      w->low_now[a] = least;
    }
  }
}

#if !CLP_LQ && !CLP_TRACKS
/* Whether the base law keeps all limits over the horizon. */
static bool clp_base_is_allowed(const clp_t* w) {
  bool allowed = true;
  for (int32_t i = 0; i < CLP_NC; i++) {
    for (int32_t a = 0; a < CLP_NU; a++) {
      const double u = w->plan_u[(i * CLP_NU) + a];
      const double low = (i == 0) ? w->low_now[a] : w->low[a];
      const double high = (i == 0) ? w->high_now[a] : w->high[a];
      allowed = allowed && (u >= low) && (u <= high);
#if !CLP_INCREMENTAL
      if ((i > 0) && (w->move[a] < CLP_UNLIMITED)) {
        allowed = allowed && (clp_abs(u - w->plan_u[((i - 1) * CLP_NU) + a]) <= w->move[a]);
      }
#endif
    }
#if CLP_SOFT > 0
    for (int32_t s = 0; s < CLP_SOFT; s++) {
      const double y = w->plan_y[(i * CLP_NY) + clp_soft[s]];
      allowed = allowed && (y >= clp_soft_lower[s]) && (y <= clp_soft_upper[s]);
    }
#endif
  }
  return allowed;
}
#endif

/* What a pulse of each input does to outputs and law, sample by sample. */
static void clp_find_pulses(clp_t* w) {
  for (int32_t a = 0; a < CLP_NU; a++) {
    double input[CLP_NU];
    for (int32_t i = 0; i < CLP_NX; i++) {
      CLP_NO_CALL;
      w->state[i] = 0.0;
    }
    for (int32_t i = 0; i < CLP_NU; i++) {
      input[i] = (i == a) ? 1.0 : 0.0;
    }
    for (int32_t k = 0; k < CLP_NC; k++) {
      const int32_t at = (k * CLP_NU) + a;
      clp_advance(w, w->state, input, false, w->next);
      clp_copy(w->next, w->state, CLP_NX);
      input[a] = 0.0;
      for (int32_t o = 0; o < CLP_NY; o++) {
        w->output_pulse[(at * CLP_NY) + o] = w->state[clp_output_row[o]];
      }
      for (int32_t b = 0; b < CLP_NU; b++) {
        double effect = 0.0;
        for (int32_t j = 0; j < CLP_NX; j++) {
          effect += w->K[(b * CLP_NX) + j] * w->state[j];
        }
        w->law_pulse[(at * CLP_NU) + b] = effect;
      }
#if CLP_LQ
      clp_copy(w->state, &w->state_pulse[at * CLP_NX], CLP_NX);
#endif
    }
  }
}

/* What input p does at the end of the horizon: which entry of the pulses. */
static int32_t clp_pulse(int32_t p) {
  return ((CLP_NC - 1 - (p / CLP_NU)) * CLP_NU) + (p % CLP_NU);
}

/* The Hessian of the inputs: block Toeplitz but for its corner, from the last sample backwards. */
static void clp_fill_hessian(clp_t* w) {
  double* H = w->qp.H;
  const int32_t width = CLP_NY + CLP_NU;
  for (int32_t p = CLP_INPUTS - 1; p >= 0; p--) {
    const int32_t a = p % CLP_NU;
    const int32_t pulse = clp_pulse(p);
    for (int32_t o = 0; o < CLP_NY; o++) {
      w->factor[(p * width) + o] =
          clp_unit[a] * clp_root_output[o] * w->output_pulse[(pulse * CLP_NY) + o];
    }
    for (int32_t b = 0; b < CLP_NU; b++) {
      double effect = 0.0;
#if !CLP_LQ
      if (pulse >= CLP_NU) {
        effect = w->law_pulse[((pulse - CLP_NU) * CLP_NU) + b];
      } else if (a == b) {
        effect = 1.0;
      } else {
        effect = 0.0;
      }
#endif
      w->factor[(p * width) + CLP_NY + b] = clp_unit[a] * clp_root_input[b] * effect;
    }
  }
  for (int32_t p = CLP_INPUTS - 1; p >= 0; p--) {
    for (int32_t q = p; q >= 0; q--) {
      double sum = 0.0;
      if ((p + CLP_NU) < CLP_INPUTS) {
        sum = H[clp_first(p + CLP_NU) + q + CLP_NU];
      }
      for (int32_t r = 0; r < width; r++) {
        sum += w->factor[(p * width) + r] * w->factor[(q * width) + r];
      }
      H[clp_first(p) + q] = sum;
    }
  }
#if CLP_LQ
  for (int32_t p = 0; p < CLP_INPUTS; p++) {
    const int32_t a = p % CLP_NU;
    const double* here = &w->state_pulse[clp_pulse(p) * CLP_NX];
    H[clp_first(p) + p] += clp_weight_input[a] * clp_unit[a] * clp_unit[a];
    for (int32_t i = 0; i < CLP_NX; i++) {
      w->next[i] = 0.0;
      for (int32_t j = 0; j < CLP_NX; j++) {
        w->next[i] += w->weight[(i * CLP_NX) + j] * here[j];
      }
    }
    for (int32_t q = 0; q <= p; q++) {
      const int32_t b = q % CLP_NU;
      const double* there = &w->state_pulse[clp_pulse(q) * CLP_NX];
      double sum = 0.0;
      for (int32_t i = 0; i < CLP_NX; i++) {
        sum += w->next[i] * there[i];
      }
      H[clp_first(p) + q] += clp_unit[a] * clp_unit[b] * sum;
    }
  }
#endif
}

/* The gradient at the base law, by one backward pass: l(i) = C' W e(i) + A' l(i+1), g(i) = B'
 * l(i+1) and, where inputs are weighed themselves, R (u - u_ss). */
static void clp_fill_gradient(clp_t* w) {
  double* l = w->next;
  double share[CLP_NY];
  for (int32_t o = 0; o < CLP_NY; o++) {
    CLP_NO_CALL;
    share[o] = clp_lead[o];
  }
  for (int32_t i = 0; i < CLP_NC; i++) {
    for (int32_t o = 0; o < CLP_NY; o++) {
      double aim = w->setpoint[o] + (share[o] * w->away[o]);
#if CLP_LQ
      aim = w->aim_x[clp_output_row[o]] + w->offset[o];
#endif
      w->error[(i * CLP_NY) + o] = clp_weight_output[o] * (w->plan_y[(i * CLP_NY) + o] - aim);
      share[o] = share[o] * clp_pole[o];
    }
  }
  for (int32_t i = 0; i < CLP_NX; i++) {
    CLP_NO_CALL;
    l[i] = 0.0;
#if CLP_LQ
    for (int32_t j = 0; j < CLP_NX; j++) { /* the state after the horizon is left by the roll-out */
      l[i] += w->weight[(i * CLP_NX) + j] * (w->square[j] - w->aim_x[j]);
    }
#endif
  }
  for (int32_t i = CLP_NC - 1; i >= 0; i--) {
    for (int32_t o = 0; o < CLP_NY; o++) {
      l[clp_output_row[o]] += w->error[(i * CLP_NY) + o];
    }
    for (int32_t a = 0; a < CLP_NU; a++) {
      double sum = 0.0;
#if CLP_LQ
      sum = clp_weight_input[a] * (w->plan_u[(i * CLP_NU) + a] - w->aim_u[a]);
#endif
      for (int32_t j = 0; j < CLP_NX; j++) {
        const int32_t kind = clp_kind[j];
        if (kind < CLP_NY) {
          sum += w->B[(kind * CLP_NU) + a] * l[j];
        } else if (kind == (CLP_NY + 1 + a)) {
          sum += l[j];
        } else {
          sum += 0.0;
        }
      }
      w->qp.g[(i * CLP_NU) + a] = clp_unit[a] * sum;
    }
    for (int32_t j = 0; j < CLP_NX; j++) {
      w->state[j] = (((j + 1) < CLP_NX) && (clp_kind[j + 1] == CLP_NY)) ? l[j + 1] : 0.0;
      for (int32_t o = 0; o < CLP_NY; o++) {
        w->state[j] += w->A[(o * CLP_NX) + j] * l[clp_output_row[o]];
      }
    }
    clp_copy(w->state, l, CLP_NX);
  }
}

/* The largest entry of H near 1; then the slacks. */
static void clp_scale_cost(clp_t* w) {
  double largest = 0.0;
  double scale;
  for (int32_t p = 0; p < CLP_INPUTS; p++) {
    const double entry = w->qp.H[clp_first(p) + p];
    largest = (entry > largest) ? entry : largest;
  }
  scale = clp_power_of_two(largest);
  for (int32_t i = 0; i < clp_first(CLP_INPUTS); i++) {
    w->qp.H[i] = w->qp.H[i] / scale;
  }
  for (int32_t p = 0; p < CLP_INPUTS; p++) {
    w->qp.g[p] = w->qp.g[p] / scale;
  }
#if CLP_SOFT > 0
  for (int32_t s = 0; s < CLP_SOFT; s++) {
    const int32_t p = CLP_INPUTS + s;
    for (int32_t j = 0; j < p; j++) {
      CLP_NO_CALL;
      w->qp.H[clp_first(p) + j] = 0.0;
    }
    w->qp.H[clp_first(p) + p] = clp_soft_weight[s];
    w->qp.g[p] = 0.0;
    w->qp.lower[p] = 0.0;
    w->qp.upper[p] = CLP_NONE;
  }
#endif
}

static void clp_fill_limits(clp_t* w) {
  clp_qp_t* q = &w->qp;
  for (int32_t i = 0; i < CLP_NC; i++) {
    for (int32_t a = 0; a < CLP_NU; a++) {
      const int32_t p = (i * CLP_NU) + a;
      const double low = (i == 0) ? w->low_now[a] : w->low[a];
      const double high = (i == 0) ? w->high_now[a] : w->high[a];
      q->lower[p] = (low > -CLP_UNLIMITED) ? ((low - w->plan_u[p]) / clp_unit[a]) : -CLP_NONE;
      q->upper[p] = (high < CLP_UNLIMITED) ? ((high - w->plan_u[p]) / clp_unit[a]) : CLP_NONE;
    }
  }
  for (int32_t k = 0; k < CLP_MOVES; k++) { /* of sample i, input a */
    const int32_t i = 1 + (k / CLP_NU);
    const int32_t a = k % CLP_NU;
    const double moved = w->plan_u[(i * CLP_NU) + a] - w->plan_u[((i - 1) * CLP_NU) + a];
    q->row_lower[k] = -CLP_NONE;
    q->row_upper[k] = CLP_NONE;
    if (w->move[a] < CLP_UNLIMITED) {
      q->row_lower[k] = (-w->move[a] - moved) / clp_unit[a];
      q->row_upper[k] = (w->move[a] - moved) / clp_unit[a];
    }
  }
#if CLP_SOFT > 0
  for (int32_t s = 0; s < CLP_SOFT; s++) {
    const int32_t o = clp_soft[s];
    double* soft = &w->soft[s * CLP_INPUTS];
    double response = 0.0;
    double unit;
    bool reached = false; /* before the dead time no input helps */
    for (int32_t p = 0; p < CLP_INPUTS; p++) {
      soft[p] = w->output_pulse[(p * CLP_NY) + o] * clp_unit[p % CLP_NU];
      response = (clp_abs(soft[p]) > response) ? clp_abs(soft[p]) : response;
    }
    unit = clp_power_of_two(response);
    for (int32_t p = 0; p < CLP_INPUTS; p++) {
      soft[p] = soft[p] / unit;
    }
    for (int32_t i = 0; i < CLP_NC; i++) {
      const int32_t above = CLP_MOVES + (2 * s * CLP_NC) + i;
      const int32_t below = above + CLP_NC;
      const double y = w->plan_y[(i * CLP_NY) + o];
      for (int32_t a = 0; a < CLP_NU; a++) {
        reached = reached || (soft[(i * CLP_NU) + a] != 0.0);
      }
      q->row_lower[above] = -CLP_NONE;
      q->row_upper[below] = CLP_NONE;
      q->row_upper[above] = CLP_NONE;
      q->row_lower[below] = -CLP_NONE;
      if (reached && (clp_soft_upper[s] < CLP_UNLIMITED)) {
        q->row_upper[above] = (clp_soft_upper[s] - y) / unit;
      }
      if (reached && (clp_soft_lower[s] > -CLP_UNLIMITED)) {
        q->row_lower[below] = (clp_soft_lower[s] - y) / unit;
      }
    }
  }
#endif
}

/* Coefficients of a row: moves by sample and input; of each output with soft limits its upper rows,
 * then its lower ones. */
static void clp_row(const clp_t* w, int32_t row, double* to) {
  for (int32_t p = 0; p < CLP_N; p++) {
    CLP_NO_CALL;
    to[p] = 0.0;
  }
  if (row < CLP_MOVES) {
    to[row + CLP_NU] = 1.0;
    to[row] = -1.0;
  }
#if CLP_SOFT > 0
  if (row >= CLP_MOVES) {
    const int32_t s = (row - CLP_MOVES) / (2 * CLP_NC);
    const int32_t at = (row - CLP_MOVES) % (2 * CLP_NC);
    const int32_t i = at % CLP_NC;
    for (int32_t j = 0; j <= i; j++) {
      const double* from = &w->soft[(s * CLP_INPUTS) + (clp_within(i - j, CLP_NC - 1) * CLP_NU)];
      for (int32_t a = 0; a < CLP_NU; a++) {
        CLP_NO_CALL;
        to[(j * CLP_NU) + a] = from[a];
      }
    }
    to[CLP_INPUTS + s] = (at < CLP_NC) ? -1.0 : 1.0;
  }
#else
  (void)w;
#endif
}

/* The values of all rows. */
static void clp_rows(const clp_t* w, const double* x, double* to) {
  for (int32_t k = 0; k < CLP_MOVES; k++) {
    to[k] = x[k + CLP_NU] - x[k];
  }
#if CLP_SOFT > 0
  for (int32_t s = 0; s < CLP_SOFT; s++) {
    const double* soft = &w->soft[s * CLP_INPUTS];
    for (int32_t i = 0; i < CLP_NC; i++) {
      const int32_t above = CLP_MOVES + (2 * s * CLP_NC) + i;
      double y = 0.0;
      for (int32_t j = 0; j <= i; j++) {
        const double* from = &soft[clp_within(i - j, CLP_NC - 1) * CLP_NU];
        for (int32_t a = 0; a < CLP_NU; a++) {
          y += from[a] * x[(j * CLP_NU) + a];
        }
      }
      to[above] = y - x[CLP_INPUTS + s];
      to[above + CLP_NC] = y + x[CLP_INPUTS + s];
    }
  }
#else
  (void)w;
#endif
}

/* Puts u inside guard, moves and bounds, and says what became of it. */
static void clp_protect(clp_t* w) {
  bool clipped = false;
  bool moved = false;
  for (int32_t a = 0; a < CLP_NU; a++) {
    const double asked = w->u[a];
    double to = ((asked - asked) == 0.0) ? asked : w->base[a]; /* a finite one */
    to = clp_bounded(to, w->least[a], w->most[a]);
    if (w->move[a] < CLP_UNLIMITED) {
      to = clp_bounded(to, w->previous[a] - w->move[a], w->previous[a] + w->move[a]);
    }
    to = clp_bounded(to, w->lower[a], w->upper[a]);
    clipped = clipped || (clp_abs(to - asked) > (CLP_NEGLIGIBLE * clp_unit[a]));
    moved = moved || (clp_abs(to - w->base[a]) > (CLP_NEGLIGIBLE * clp_unit[a]));
    w->u[a] = to;
  }
  if (clipped) {
    w->source = 3;
  } else if (moved && (w->status == CLP_SOLVED)) {
    w->source = 2;
  } else {
    w->source = 1;
  }
}

/* One sample: at most `most` working sets; where that is not enough the base law's action is
 * clipped. */
static void clp_step(clp_t* w, int32_t most) {
  bool aimed = true;
  bool base = false;
  w->iterations = 0;
  w->active = 0;
  w->status = CLP_FAILED;
  clp_copy(w->base, w->u, CLP_NU);
#if CLP_TARGET
  aimed = clp_find_target(w);
#endif
#if CLP_LQ
  aimed = aimed && clp_weigh_end(w);
#endif
  if (aimed) {
    clp_roll_out(w);
#if CLP_LQ
    clp_copy(w->state, w->square, CLP_NX);
#endif
    clp_set_limits(w);
#if !CLP_LQ && !CLP_TRACKS
    base = clp_base_is_allowed(w);
#endif
    w->status = CLP_SOLVED;
    if (!base) {
      clp_find_pulses(w);
      clp_fill_hessian(w);
      clp_fill_gradient(w);
      clp_scale_cost(w);
      clp_fill_limits(w);
      w->status = clp_solve(w, most);
      w->iterations = w->qp.iterations;
    }
    if (!base && (w->status == CLP_SOLVED)) {
      w->active = clp_count(&w->qp);
      for (int32_t a = 0; a < CLP_NU; a++) {
        w->u[a] = w->base[a] + (w->qp.x[a] * clp_unit[a]);
      }
    }
  }
  clp_protect(w);
}
