// Valves that do not do what they are told, each known on paper: limit 2 per sample, range 0..20.
#include "runtime/move_origin.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace fpc {
namespace control_move_origin_test {

Vector one(double value) { return Vector::Constant(1, value); }

InputLimits limits(double move = 2.0) { return {one(0.0), one(20.0), one(move)}; }

/// What is sent when the law asks for `asked` and `applied` is read.
double send(MoveOrigin& moves, double applied, double asked, double move = 2.0) {
  moves.look(one(applied));
  Vector input = one(asked);
  limits(move).clip(input, moves.origin());
  moves.keepNear(input);
  moves.sent(input);
  return input[0];
}

TEST(MoveOrigin, AnInputThatIsWhereItWasToldMovesOnFromThereToTheBit) {
  MoveOrigin moves(limits());
  double applied = 8.0 + 1e-12;
  for (const double asked : {20.0, 20.0, 0.0, 3.0}) {
    moves.look(one(applied));
    EXPECT_EQ(moves.origin()[0], applied);
    EXPECT_FALSE(moves.displaced());
    Vector input = one(asked);
    limits().clip(input, moves.origin());
    moves.sent(input);
    applied = input[0];
  }
}

TEST(MoveOrigin, AnOffsetLargerThanTheMoveLimitIsNotTakenUpAnew) {
  for (const double offset : {-5.0, -2.5, -2.0, -0.5, 0.5, 1.9, 2.0, 2.5, 5.0}) {
    MoveOrigin moves(limits());
    double command = send(moves, 10.0, 10.0);
    for (const double asked : {10.0, 10.0, 4.0, 4.0, 4.0, 4.0, 9.0, 9.0, 9.0}) {
      const double next = send(moves, command + offset, asked);
      const double towards =
          std::copysign(std::min(2.0, std::abs(asked - command)), asked - command);
      EXPECT_DOUBLE_EQ(next, command + towards) << offset;
      command = next;
    }
  }
}

TEST(MoveOrigin, NothingWindsUpAgainstAStuckValveAndItsCommandComesToItInSteps) {
  MoveOrigin moves(limits());
  double command = send(moves, 14.0, 15.0);
  EXPECT_EQ(command, 15.0);
  double last = command;
  for (int k = 0; k < 20; ++k) {
    command = send(moves, 5.0, 20.0);
    EXPECT_LE(std::abs(command - last), 2.0 + 1e-12) << k;
    last = command;
  }
  EXPECT_DOUBLE_EQ(command, 7.0) << "one move from where the valve stands";
}

TEST(MoveOrigin, AnActionThatWasLostIsMadeUpForFromWhatIsRead) {
  MoveOrigin moves(limits());
  send(moves, 8.0, 8.0);
  EXPECT_EQ(send(moves, 8.0, 10.0), 10.0);
  EXPECT_EQ(send(moves, 8.0, 20.0), 10.0) << "8 still acts";
  EXPECT_EQ(send(moves, 10.0, 20.0), 12.0);
}

TEST(MoveOrigin, AfterARestartAndWithoutAMoveLimitWhatIsReadCounts) {
  MoveOrigin moves(limits());
  send(moves, 8.0, 8.0);
  moves.restart();
  moves.look(one(13.0));
  EXPECT_EQ(moves.origin()[0], 13.0);
  EXPECT_FALSE(moves.displaced());
  const double infinite = std::numeric_limits<double>::infinity();
  MoveOrigin free(limits(infinite));
  send(free, 8.0, 8.0, infinite);
  EXPECT_EQ(send(free, 13.0, 1.0, infinite), 1.0);
  EXPECT_FALSE(free.displaced());
}

}  // namespace control_move_origin_test
}  // namespace fpc
