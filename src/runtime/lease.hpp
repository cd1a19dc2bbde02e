// Leadership of a plant by a word in one of its registers: who wrote it leads, until the plant or
// the leader takes it away.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fpc {

/// Each round: held() with what the register holds, then what toWrite() says. A word counts only
/// once it has been read back. The plant puts 0 there when its leader is gone.
class Lease {
 public:
  /// `word`: ours, not 0; `place`: of the register, in words.
  Lease(std::uint16_t word, std::string place) : word_(word), place_(std::move(place)) {}
  void held(std::uint16_t word, double now_s);
  /// The connection was lost: what became of the word meanwhile is no loss.
  void forget() { read_ = was_ours_ = false; }
  /// To claim or renew it, or 0 to give it back; nothing: it is another's, or nobody wants it.
  std::optional<std::uint16_t> toWrite(bool claims);
  bool leads() const { return read_ && held_ == word_; }
  bool another() const { return read_ && held_ != 0 && held_ != word_; }
  /// Who leads in place of us, as long as that lasts; or that leadership was lost, for a while.
  std::string problem(double now_s) const;
  std::uint64_t losses() const { return losses_; }

 private:
  static constexpr double kShown = 2.0;  // [s] after it was lost

  std::uint16_t word_, held_{};
  std::string place_;
  bool read_{false}, was_ours_{false};
  double lost_s_{-kShown};
  std::uint64_t losses_{};
};

}  // namespace fpc
