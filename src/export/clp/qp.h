/* The workspace of a quadratic programme of CLP_N unknowns and CLP_M rows; see clp_solve(). */
typedef struct {
  /* what is asked: min 1/2 x'Hx + g'x, lower <= x <= upper, row_lower <= rows(x) <= row_upper */
  double H[(CLP_N * (CLP_N + 1)) / 2]; /* lower triangle, row by row */
  double g[CLP_N];
  double lower[CLP_N];
  double upper[CLP_N]; /* CLP_NONE and beyond: no limit */
  double row_lower[CLP_ROWS];
  double row_upper[CLP_ROWS];
  /* what is answered */
  double x[CLP_N];
  int32_t iterations; /* working sets tried */
  int32_t count;      /* constraints in the working set */
  /* work: J'HJ = I and J'N = [R; 0] for the normals N of the working set */
  double J[CLP_N * CLP_N]; /* row by row */
  double
      R[(CLP_N * (CLP_N + 1)) / 2]; /* upper triangle, column by column; before, the factor of H */
  double y[CLP_N];                  /* multipliers of the working set */
  double d[CLP_N];                  /* J'n of the constraint that enters */
  double z[CLP_N];                  /* step of x */
  double r[CLP_N];                  /* step of y */
  double c[CLP_N];
  double normal[CLP_N];
  double turn_c[CLP_N]; /* rotations of a removal */
  double turn_s[CLP_N];
  double scale[CLP_N];        /* sqrt of H_ii */
  double row_scale[CLP_ROWS]; /* 1 / norm of a row in the metric diag(H)^-1 */
  double row_size[CLP_ROWS];  /* sum of |coefficient| */
  double row_value[CLP_ROWS];
  int32_t set[CLP_N]; /* the working set: bound i < CLP_N, or CLP_N + row */
  /* 1 at its lower limit, -1 at its upper, 0 off, 2 given up as redundant */
  int8_t side[CLP_N + CLP_ROWS];
} clp_qp_t;
