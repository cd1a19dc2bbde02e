#include "analysis/csdp.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <utility>

namespace fpc {
namespace {

namespace fs = std::filesystem;
constexpr int kNotFound = 127;
constexpr double kSmallest = 1e-300;  // entries below are not written

/// A folder that goes when the solver is done.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (fs::temp_directory_path() / "fmbpc_csdp_XXXXXX").string();
    if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~Scratch() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  bool ok() const { return !path_.empty(); }
  std::string file(const char* name) const { return (fs::path(path_) / name).string(); }

 private:
  std::string path_;
};

/// Upper triangle of a symmetric block, in the sparse format of SDPA.
void writeBlock(std::ofstream& out, int variable, std::size_t block, const Matrix& F) {
  for (Eigen::Index i = 0; i < F.rows(); ++i)
    for (Eigen::Index j = i; j < F.cols(); ++j)
      if (std::abs(F(i, j)) > kSmallest)
        out << variable << " " << block << " " << i + 1 << " " << j + 1 << " " << F(i, j) << "\n";
}

/// min -t over (p_11, p_12, .., t): sum x_i F_i - F_0 >= 0.
void writeProblem(const std::string& file, const std::vector<Matrix>& maps, double decay) {
  const Eigen::Index n = maps.front().rows(), n_p = n * (n + 1) / 2;
  std::ofstream out(file);
  out << std::setprecision(17) << n_p + 1 << "\n" << maps.size() + 2 << "\n";
  for (std::size_t i = 0; i < maps.size() + 2; ++i) out << n << " ";
  out << "\n";
  for (Eigen::Index i = 0; i < n_p; ++i) out << "0 ";
  out << "-1\n";
  writeBlock(out, 0, 2, -Matrix::Identity(n, n));
  int variable = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = i; j < n; ++j) {
      Matrix E = Matrix::Zero(n, n);
      E(i, j) = E(j, i) = 1.0;
      ++variable;
      writeBlock(out, variable, 1, E);
      writeBlock(out, variable, 2, -E);
      for (std::size_t k = 0; k < maps.size(); ++k)
        writeBlock(out, variable, k + 3, decay * decay * E - maps[k].transpose() * E * maps[k]);
    }
  for (std::size_t k = 0; k < maps.size(); ++k)
    writeBlock(out, variable + 1, k + 3, -Matrix::Identity(n, n));
}

int runSolver(const std::string& problem, const std::string& solution) {
  const pid_t child = fork();
  if (child < 0) return -1;
  if (child == 0) {
    const int nothing = open("/dev/null", O_RDWR);
    dup2(nothing, STDIN_FILENO);
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
    setenv("OMP_NUM_THREADS", "1", 1);
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    execlp("csdp", "csdp", problem.c_str(), solution.c_str(), static_cast<char*>(nullptr));
    _exit(kNotFound);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

CsdpOutcome solveDecay(const std::vector<Matrix>& maps, double decay, Matrix& P, double& margin) {
  const Scratch scratch;
  if (!scratch.ok()) return CsdpOutcome::kTrouble;
  const std::string problem = scratch.file("problem.dat-s"), solution = scratch.file("solution");
  writeProblem(problem, maps, decay);
  if (runSolver(problem, solution) == kNotFound) return CsdpOutcome::kMissing;
  std::ifstream in(solution);
  const Eigen::Index n = maps.front().rows();
  P.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = i; j < n; ++j) {
      in >> P(i, j);
      P(j, i) = P(i, j);
    }
  in >> margin;
  return in && P.allFinite() ? CsdpOutcome::kSolved : CsdpOutcome::kTrouble;
}

}  // namespace fpc
