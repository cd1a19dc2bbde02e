#include "tool/mpi_pool.hpp"

#include <chrono>
#include <cstdio>
#include <future>

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include "tool/mpi_wire.hpp"

namespace fpc::tool {
namespace {

constexpr std::chrono::seconds kPatience{5};  // of a rank that failed, for the others to meet it

}  // namespace

MpiPool::MpiPool() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
}

/// What rank 0 does in fill().
class MpiPool::Dealer {
 public:
  Dealer(Texts& texts, const std::vector<std::size_t>& order, const Work& work, const Done& done,
         int ranks)
      : texts_(texts), order_(order), work_(work), done_(done), others_(ranks - 1) {}

  void deal() {
    while (others_ > 0 || own_.valid() || open()) {
      const bool heard = hear();
      const bool worked = workItself();
      if (!heard && !worked) nap();
    }
  }

 private:
  bool open() const { return !stopped_ && next_ < order_.size(); }

  void take(std::size_t run, std::optional<std::string> text) {
    stopped_ = stopped_ || !text;
    if (!text) return;
    if (done_) done_(run, *text);
    texts_[run] = std::move(text);
  }

  /// An answer of another rank, if there is one: it gets the next number, or is sent home.
  bool hear() {
    if (others_ == 0) return false;
    const std::optional<Answer> answer = receiveAnswer();
    if (!answer) return false;
    if (answer->run != kNoRun) take(answer->run, answer->text);
    others_ -= !open();
    sendNumber(open() ? order_[next_++] : kNoRun, answer->rank);
    return true;
  }

  bool workItself() {
    if (own_.valid() && own_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
      return false;
    if (!own_.valid() && !open()) return false;
    if (own_.valid()) take(own_run_, own_.get());
    if (!open()) return true;
    own_run_ = order_[next_++];
    own_ = std::async(std::launch::async, work_, own_run_);
    return true;
  }

  Texts& texts_;
  const std::vector<std::size_t>& order_;
  const Work& work_;
  const Done& done_;
  int others_;  // that have not been sent home
  std::size_t next_{};
  bool stopped_{false};
  std::future<std::optional<std::string>> own_;
  std::size_t own_run_{};
};

void MpiPool::fill(Texts& texts, const std::vector<std::size_t>& order, const Work& work,
                   const Done& done) {
  meet();
  if (leads())
    Dealer(texts, order, work, done, ranks_).deal();
  else
    serve(work);
  share(texts);
}

void MpiPool::serve(const Work& work) const {
  sendAnswer(kNoRun, std::nullopt);
  for (std::size_t run = receiveNumber(); run != kNoRun; run = receiveNumber())
    sendAnswer(run, work(run));
}

void MpiPool::share(Texts& texts) const {
  std::string packed = leads() ? pack(texts) : std::string();
  broadcast(packed);
  if (!leads()) texts = unpack(packed);
}

void MpiPool::meet() const {
  if (lowestFailure(ranks_, std::nullopt) < ranks_) throw OtherRankFailed();
}

void MpiPool::fail(const std::string& why) const {
  const int lowest = lowestFailure(rank_, kPatience);
  if (lowest == rank_ || lowest == kNobodyCame) {
    const std::string who = leads() ? "" : "rank " + std::to_string(rank_) + ": ";
    std::fprintf(stderr, "fmbpc: %s%s\n", who.c_str(), why.c_str());
  }
  if (lowest == kNobodyCame) MPI_Abort(MPI_COMM_WORLD, 1);
}

}  // namespace fpc::tool
