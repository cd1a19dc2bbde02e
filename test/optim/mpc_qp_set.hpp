// The public set of quadratic programmes of model predictive control (qpsolvers/mpc_qpbenchmark,
// min x'Px/2 + q'x with Gx <= h, Ax = b, lb <= x <= ub): read from the folder mpc_qp of the public
// records by Debian's python3-numpy.
#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "optim/qp.hpp"
#include "paths.hpp"

namespace fpc::testing {

using NamedArrays = std::map<std::string, Matrix>;
using MpcQpSet = std::map<std::string, NamedArrays>;  // by the file's name

/// One array from the pipe of npz_dump.py. @return whether there was one
inline bool readArray(std::FILE* pipe, MpcQpSet& set) {
  char file[256], name[64];
  long rows = 0, columns = 0;
  if (std::fscanf(pipe, "%255s %63s %ld %ld", file, name, &rows, &columns) != 4) return false;
  if (std::fgetc(pipe) != '\n') throw std::runtime_error("npz_dump.py: no line end");
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> M(rows, columns);
  const auto count = static_cast<std::size_t>(M.size());
  if (std::fread(M.data(), sizeof(double), count, pipe) != count)
    throw std::runtime_error("npz_dump.py: array is cut off");
  set[file][name] = M;
  return true;
}

/// All .npz files of the folder whose names begin like that.
inline MpcQpSet readMpcQpSet(const std::filesystem::path& folder, const std::string& begin = "") {
  std::string command = "/usr/bin/python3 '" + sourceDir() + "/test/optim/npz_dump.py'";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto& path = entry.path();
    if (path.extension() == ".npz" && path.filename().string().rfind(begin, 0) == 0)
      command += " '" + path.string() + "'";
  }
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  MpcQpSet set;
  while (readArray(pipe, set)) {
  }
  if (pclose(pipe) != 0) throw std::runtime_error("failed: " + command);
  return set;
}

/// G x <= h above A x = b, as they come.
inline QpProblem toProblem(const NamedArrays& a) {
  const auto rowsOf = [&](const char* name) {
    return a.count(name) != 0 ? a.at(name).rows() : Eigen::Index{0};
  };
  const Eigen::Index m_g = rowsOf("G"), m_a = rowsOf("A");
  QpProblem p(a.at("P").rows(), m_g + m_a);
  p.H = a.at("P");
  p.g = a.at("q");
  if (m_g > 0) {
    p.A.topRows(m_g) = a.at("G");
    p.a_upper.head(m_g) = a.at("h");
  }
  if (m_a > 0) {
    p.A.bottomRows(m_a) = a.at("A");
    p.a_lower.tail(m_a) = p.a_upper.tail(m_a) = a.at("b");
  }
  if (a.count("lb") != 0) p.x_lower = a.at("lb");
  if (a.count("ub") != 0) p.x_upper = a.at("ub");
  return p;
}

/// The three residuals of the benchmark, in the units of the problem.
struct AbsoluteResiduals {
  double primal{}, dual{}, gap{};
  double worst() const { return std::max({primal, dual, gap}); }
};

/// Part of one constraint in the duality gap: multiplier times the limit it stands for.
inline double supportOf(double y, double lower, double upper) {
  return y == 0.0 ? 0.0 : y * (y > 0.0 ? lower : upper);
}

inline AbsoluteResiduals absoluteResiduals(const QpProblem& p, const QpResult& r) {
  AbsoluteResiduals e;
  const Vector Hx = p.H * r.x, Ax = p.A * r.x, Aty = p.A.transpose() * r.y_a;
  e.dual = (Hx + p.g - r.y_x - Aty).lpNorm<Eigen::Infinity>();
  e.gap = r.x.dot(Hx) + p.g.dot(r.x);
  for (Eigen::Index i = 0; i < r.x.size(); ++i) {
    e.primal = std::max({e.primal, p.x_lower(i) - r.x(i), r.x(i) - p.x_upper(i)});
    e.gap -= supportOf(r.y_x(i), p.x_lower(i), p.x_upper(i));
  }
  for (Eigen::Index i = 0; i < Ax.size(); ++i) {
    e.primal = std::max({e.primal, p.a_lower(i) - Ax(i), Ax(i) - p.a_upper(i)});
    e.gap -= supportOf(r.y_a(i), p.a_lower(i), p.a_upper(i));
  }
  e.gap = std::abs(e.gap);
  return e;
}

}  // namespace fpc::testing
