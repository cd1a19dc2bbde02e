// The exported QP solver as a part of a test: define CLP_N and CLP_M, include this inside a
// namespace of its own. No include guard: once for each size.
#define CLP_ROWS (CLP_M > 0 ? CLP_M : 1)
#define CLP_NO_CALL ((void)0)

#include "export/clp/qp.h"

struct clp_t {
  double A[CLP_ROWS * CLP_N];
  clp_qp_t qp;
};
inline double clp_root(double v) { return std::sqrt(v); }
static void clp_row(const clp_t* w, int32_t row, double* to) {
  for (int32_t j = 0; j < CLP_N; ++j) to[j] = w->A[row * CLP_N + j];
}
static void clp_rows(const clp_t* w, const double* x, double* to) {
  for (int32_t k = 0; k < CLP_M; ++k) {
    to[k] = 0.0;
    for (int32_t j = 0; j < CLP_N; ++j) to[k] += w->A[k * CLP_N + j] * x[j];
  }
}

#include "export/clp/qp.c"

inline ExportedAnswer solve(const QpProblem& p, int most = 1000) {
  static clp_t w;
  const auto finite = [](double v) { return std::clamp(v, -CLP_NONE, CLP_NONE); };
  for (int32_t i = 0; i < CLP_N; ++i) {
    for (int32_t j = 0; j <= i; ++j) w.qp.H[clp_first(i) + j] = p.H(i, j);
    w.qp.g[i] = p.g(i);
    w.qp.lower[i] = finite(p.x_lower(i));
    w.qp.upper[i] = finite(p.x_upper(i));
  }
  for (int32_t k = 0; k < CLP_M; ++k) {
    for (int32_t j = 0; j < CLP_N; ++j) w.A[k * CLP_N + j] = p.A(k, j);
    w.qp.row_lower[k] = finite(p.a_lower(k));
    w.qp.row_upper[k] = finite(p.a_upper(k));
  }
  ExportedAnswer answer;
  answer.status = static_cast<SolveStatus>(clp_solve(&w, most));
  answer.x = Vector::Map(w.qp.x, CLP_N);
  answer.iterations = w.qp.iterations;
  answer.active = w.qp.count;
  return answer;
}

#undef CLP_N
#undef CLP_M
#undef CLP_ROWS
#undef CLP_NO_CALL
#undef CLP_NONE
#undef CLP_EXACT
#undef CLP_SOLVED
#undef CLP_LIMIT
#undef CLP_FAILED
