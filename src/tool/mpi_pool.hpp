// The ranks of an MPI job as a pool of runs: rank 0 deals numbers of runs to whoever is free, makes
// runs itself, and tells all ranks at the end what came out. Every rank works through the same
// program, so that nothing but numbers and texts is sent. Private to the program fmbpc_mpi.
#pragma once

#include <stdexcept>
#include <string>

#include "study/run_pool.hpp"

namespace fpc::tool {

/// Another rank cannot go on and has said why.
class OtherRankFailed : public std::runtime_error {
 public:
  OtherRankFailed() : std::runtime_error("another rank failed") {}
};

/// One at a time, between MPI_Init_thread (at least MPI_THREAD_FUNNELED) and MPI_Finalize, in the
/// thread that called the former. One run at a time per rank.
class MpiPool : public RunPool {
 public:
  MpiPool();
  /// @throws OtherRankFailed
  void fill(Texts& texts, const std::vector<std::size_t>& order, const Work& work,
            const Done& done) override;
  bool leads() const override { return rank_ == 0; }
  int width() const override { return ranks_; }
  /// Waits for all ranks, as fill() does first. @throws OtherRankFailed
  void meet() const;
  /// This rank cannot go on. The lowest rank that fails says why; if the others are not about to
  /// meet (within seconds) the whole job is ended.
  void fail(const std::string& why) const;

 private:
  class Dealer;
  void serve(const Work& work) const;
  void share(Texts& texts) const;

  int rank_{}, ranks_{1};
};

}  // namespace fpc::tool
