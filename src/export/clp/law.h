/* The constraint optimizer of one sample: see clp_step(). */
typedef struct {
  /* given: y(k+1) = A x + B u + g of each output; the base law
   * u = -K x + L (y_r - setpoint) + what is constant */
  double x[CLP_NX];
  double A[CLP_NY * CLP_NX];
  double B[CLP_NY * CLP_NU];
  double g[CLP_NY];
  double d[CLP_ND];      /* disturbances */
  double offset[CLP_NY]; /* measured less the model's, kept over the horizon */
  double K[CLP_NU * CLP_NX];
  double L[CLP_NU * CLP_NY];
  double away[CLP_NY]; /* reference less setpoint */
  double setpoint[CLP_NY];
  double bias[CLP_NU];     /* of the hand-over, in the base action */
  double base[CLP_NU];     /* the law's action, before any limit */
  double previous[CLP_NU]; /* from where moves count */
  double lower[CLP_NU];
  double upper[CLP_NU];
  double move[CLP_NU];
  double least[CLP_NU]; /* of u(k), as the guard leaves it */
  double most[CLP_NU];
  /* answered */
  double u[CLP_NU];
  int32_t source;     /* 1 the law, 2 constrained, 3 clipped */
  int32_t status;     /* 1 solved, 3 more than the allowed iterations, 4 not solvable in numbers */
  int32_t iterations; /* working sets tried; 0: the base law keeps all limits */
  int32_t active;     /* limits that hold the plan */
  /* work */
  double low[CLP_NU]; /* of the samples after the first */
  double high[CLP_NU];
  double low_now[CLP_NU];
  double high_now[CLP_NU];
  double plan_u[CLP_NU * CLP_NC]; /* the base law, rolled out */
  double plan_y[CLP_NY * CLP_NC];
  double output_pulse[CLP_NY * CLP_NU * CLP_NC];
  double law_pulse[CLP_NU * CLP_NU * CLP_NC];
  double factor[CLP_NU * CLP_NC * (CLP_NY + CLP_NU)];
  double error[CLP_NY * CLP_NC]; /* weighted */
  double soft[CLP_SOFTS * CLP_NU * CLP_NC];
  double state[CLP_NX];
  double next[CLP_NX];
#if CLP_TARGET
  double system[(CLP_NX + CLP_NU) * (CLP_NX + CLP_NU)];
  double right[CLP_NX + CLP_NU];
  double aim_x[CLP_NX];
  double aim_u[CLP_NU];
  int32_t order[CLP_NX + CLP_NU];
#endif
#if CLP_LQ
  double state_pulse[CLP_NX * CLP_NU * CLP_NC];
  double weight[CLP_NX * CLP_NX]; /* of the state after the horizon */
  double power[CLP_NX * CLP_NX];
  double product[CLP_NX * CLP_NX];
  double square[CLP_NX * CLP_NX];
#endif
  clp_qp_t qp;
} clp_t;
