#pragma once

#include <memory>

namespace holdfast::wire {

/// Has this process wait for the sockets of gRPC's reactors with one thread where gRPC itself would
/// have two. Of two that wait at the same queue each hands the next event to the other one, which
/// costs a stream nearly a third of its rate. For the main function of a program, since it holds
/// for all of the process: nobody's reactions may block then.
void prefer_one_poller();

/// For whoever is about to use reactors: there is one such thread for as long as anybody holds what
/// this returns. Null, and no change, unless it is preferred and gRPC has two: with up to five
/// processors. With more, streams on one thread would have less than they could.
std::shared_ptr<void> hold_one_poller();

}  // namespace holdfast::wire
