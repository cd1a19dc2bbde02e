// A node that starts finds its neighbours at once, not at roscpp's next look.
#pragma once

namespace fpc {

/// The thread of roscpp that agrees with other nodes on connections takes up what is new every
/// 100 ms: a connection costs two such waits, and a loop starts after several in a row. For the
/// first five seconds of a node it is woken every 5 ms. To be called before the first NodeHandle of
/// a process, since the first wait has begun after it, or at any later time.
void negotiateQuickly();

}  // namespace fpc
