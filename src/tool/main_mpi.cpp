// fmbpc_mpi: `fmbpc study` and `fmbpc tune` with their runs spread over the ranks of an MPI job.
// mpirun -n 16 fmbpc study ... becomes this program.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "fmbpc/base/input_error.hpp"
#include "tool/mpi_pool.hpp"
#include "tool/printed.hpp"
#include "tool/program.hpp"
#include "tool/study_options.hpp"

namespace {

using fpc::tool::MpiPool;

int work(int argc, char** argv, const std::shared_ptr<MpiPool>& pool) {
  CLI::App app{"The commands of fmbpc that spread over MPI ranks", "fmbpc_mpi"};
  app.require_subcommand(1);
  std::function<int()> chosen;
  fpc::tool::TuneArguments tune;
  fpc::tool::addTune(app, tune, chosen);
  fpc::tool::StudyArguments study;
  fpc::tool::addStudy(app, study, chosen);
  tune.pool = study.pool = pool;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return pool->leads() ? app.exit(e) : 0;
    throw fpc::InputError(fpc::tool::wrongWith(app, e, argc, argv));
  }
  fpc::require(tune.threads == 0 && study.threads == 0, "--threads",
               "nothing under mpirun: each rank makes one run at a time");
  const int code = chosen();
  pool->meet();
  return code;
}

int guardedWork(int argc, char** argv) {
  const auto pool = std::make_shared<MpiPool>();
  try {
    return work(argc, argv, pool);
  } catch (const fpc::tool::OtherRankFailed&) {
    return 1;
  } catch (const std::exception& e) {
    pool->fail(e.what());
  }
  return 1;
}

/// What ranks send each other is small and seldom: sockets and shared memory will do. The search
/// for faster networks, each tried in turn, takes two thirds of the start. Whoever names a way gets
/// it.
void passOverFabrics() { setenv("OMPI_MCA_pml", "ob1", 0); }

}  // namespace

int main(int argc, char** argv) {
  int level = 0;
  passOverFabrics();
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  if (level < MPI_THREAD_FUNNELED) {
    std::fprintf(stderr, "fmbpc: expected an MPI that lets a program have threads\n");
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  const int code = fpc::tool::printed(guardedWork(argc, argv));
  MPI_Finalize();
  return code;
}
