#include "tool/mpi_wire.hpp"

#include <algorithm>
#include <climits>
#include <cstring>
#include <thread>

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

namespace fpc::tool {
namespace {

constexpr int kAnswer = 1, kNumber = 2;

/// A message is the number of a run, a mark whether a text follows, the text.
std::string messageOf(std::size_t run, const std::optional<std::string>& text) {
  std::string bytes(sizeof run, '\0');
  std::memcpy(bytes.data(), &run, sizeof run);
  bytes += text ? 't' : '-';
  return text ? bytes + *text : bytes;
}

std::string receive(const MPI_Status& status) {
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return bytes;
}

void send(const std::string& bytes, int rank, int tag) {
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, rank, tag, MPI_COMM_WORLD);
}

std::optional<std::string> receiveIfThere(int rank, int tag, int& from) {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(rank, tag, MPI_COMM_WORLD, &there, &status);
  if (there == 0) return std::nullopt;
  from = status.MPI_SOURCE;
  return receive(status);
}

/// False if it took longer than that.
bool finish(MPI_Request& request, std::optional<std::chrono::seconds> patience) {
  const auto began = std::chrono::steady_clock::now();
  for (;;) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return true;
    if (patience && std::chrono::steady_clock::now() - began > *patience) return false;
    nap();
  }
}

}  // namespace

void nap() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

void sendAnswer(std::size_t run, const std::optional<std::string>& text) {
  send(messageOf(run, text), 0, kAnswer);
}

std::optional<Answer> receiveAnswer() {
  Answer answer;
  const auto bytes = receiveIfThere(MPI_ANY_SOURCE, kAnswer, answer.rank);
  if (!bytes) return std::nullopt;
  std::memcpy(&answer.run, bytes->data(), sizeof answer.run);
  if ((*bytes)[sizeof answer.run] == 't') answer.text = bytes->substr(sizeof answer.run + 1);
  return answer;
}

void sendNumber(std::size_t run, int rank) { send(messageOf(run, std::nullopt), rank, kNumber); }

std::size_t receiveNumber() {
  int from = 0;
  std::optional<std::string> bytes;
  while (!(bytes = receiveIfThere(0, kNumber, from))) nap();
  std::size_t run = 0;
  std::memcpy(&run, bytes->data(), sizeof run);
  return run;
}

void broadcast(std::string& bytes) {
  auto size = static_cast<std::uint64_t>(bytes.size());
  MPI_Request request;
  MPI_Ibcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, &request);
  finish(request, std::nullopt);
  bytes.resize(size);
  for (std::size_t at = 0; at < bytes.size(); at += INT_MAX) {
    const int part = static_cast<int>(std::min<std::size_t>(INT_MAX, bytes.size() - at));
    MPI_Ibcast(bytes.data() + at, part, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    finish(request, std::nullopt);
  }
}

std::string pack(const RunPool::Texts& texts) {
  std::string bytes;
  for (const auto& text : texts) bytes += messageOf(text ? text->size() : kNoRun, text);
  return bytes;
}

RunPool::Texts unpack(const std::string& bytes) {
  RunPool::Texts texts;
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t size = 0;
    std::memcpy(&size, bytes.data() + at, sizeof size);
    at += sizeof size + 1;
    texts.emplace_back();
    if (size == kNoRun) continue;
    texts.back() = bytes.substr(at, size);
    at += size;
  }
  return texts;
}

int lowestFailure(int mine, std::optional<std::chrono::seconds> patience) {
  int lowest = mine;
  MPI_Request request;
  MPI_Iallreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD, &request);
  return finish(request, patience) ? lowest : kNobodyCame;
}

}  // namespace fpc::tool
