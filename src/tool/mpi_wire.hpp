// What travels between the ranks of fmbpc_mpi, and how they wait: by asking and napping, as Open
// MPI's own waits keep a core busy. Private to it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "study/run_pool.hpp"

namespace fpc::tool {

constexpr std::size_t kNoRun = SIZE_MAX;
constexpr int kNobodyCame = -1;

struct Answer {
  int rank{};
  std::size_t run{};
  std::optional<std::string> text;
};

void nap();
/// To rank 0. kNoRun: ready for the first one.
void sendAnswer(std::size_t run, const std::optional<std::string>& text);
/// Of any rank, if one is there.
std::optional<Answer> receiveAnswer();
void sendNumber(std::size_t run, int rank);
/// Of rank 0; waits for it.
std::size_t receiveNumber();
/// From rank 0 to all.
void broadcast(std::string& bytes);
std::string pack(const RunPool::Texts& texts);
RunPool::Texts unpack(const std::string& bytes);
/// All ranks call it: the least of what they say. kNobodyCame if not all of them come in time.
int lowestFailure(int mine, std::optional<std::chrono::seconds> patience);

}  // namespace fpc::tool
