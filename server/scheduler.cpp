#include "server/scheduler.h"

#include <algorithm>

namespace holdfast::server {
namespace {

int thread_count(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// A quarter of the threads lead: a frame alone then has most of the machine, and short frames of
/// many sessions still run side by side. Ours.
int leader_count(int threads) { return std::max(1, threads / 4); }

}  // namespace

int Scheduler::frames_at_once(int threads) { return leader_count(thread_count(threads)); }

Scheduler::Scheduler(int threads, Clock clock)
    : clock_(std::move(clock)),
      threads_(thread_count(threads)),
      leaders_(leader_count(threads_)),
      arena_(threads_, static_cast<unsigned>(leaders_)) {
  // oneTBB makes one worker less than there are cores; more must be asked for.
  if (threads_ > static_cast<int>(std::thread::hardware_concurrency()))
    more_workers_.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                          static_cast<std::size_t>(threads_));
  for (int i = 0; i < leaders_; ++i) pool_.emplace_back([this] { lead(); });
}

Scheduler::~Scheduler() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : pool_) thread.join();
}

void Scheduler::post(const std::shared_ptr<Strand>& strand, std::function<void()> job,
                     std::optional<std::chrono::steady_clock::time_point> deadline,
                     bool newest_first) {
  {
    const std::lock_guard lock(mutex_);
    strand->jobs_.push_back({std::move(job), deadline, newest_first});
    strand->newest_ = ++posted_;
    if (strand->ready_) return;
    strand->ready_ = strand->fresh_ = true;
    strand->used_ = std::max(strand->used_, level_);
    line_.push_back(strand);
  }
  wake_.notify_one();
}

/// Takes the strand whose turn it is out of the line; called with the mutex held.
std::shared_ptr<Strand> Scheduler::next() {
  const auto it = turn();
  std::shared_ptr<Strand> strand = std::move(*it);
  line_.erase(it);
  return strand;
}

Scheduler::Line::iterator Scheduler::turn() {
  const auto least =
      (*std::min_element(line_.begin(), line_.end(), [](const auto& a, const auto& b) {
        return a->used_ < b->used_;
      }))->used_;
  level_ = std::max(level_, least);
  const auto goes_before = [](const Strand& a, const Strand& b) {
    constexpr auto kNever = std::chrono::steady_clock::time_point::max();
    const auto due_a = a.jobs_.front().deadline.value_or(kNever);
    const auto due_b = b.jobs_.front().deadline.value_or(kNever);
    if (due_a != due_b) return due_a < due_b;
    if (a.fresh_ || b.fresh_) return a.fresh_ && !b.fresh_;
    return a.used_ < b.used_;
  };
  auto first = line_.end(), newest = line_.end();
  for (auto it = line_.begin(); it != line_.end(); ++it) {
    if ((*it)->used_ > least + kSlack) continue;
    if ((*it)->jobs_.front().newest_first) {
      if (newest == line_.end() || (*it)->newest_ > (*newest)->newest_) newest = it;
      continue;
    }
    if (first == line_.end() || goes_before(**it, **first)) first = it;
  }
  if (first == line_.end()) return newest;
  if (newest == line_.end()) return first;
  return (*newest)->used_ < (*first)->used_ ? newest : first;
}

void Scheduler::lead() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return stopping_ || !line_.empty(); });
    if (line_.empty()) return;
    const std::shared_ptr<Strand> strand = next();
    std::function<void()> job = std::move(strand->jobs_.front().run);
    strand->jobs_.pop_front();
    lock.unlock();
    const auto start = clock_();
    // Isolated: while this thread waits for the end of its own loop it takes no other frame's work.
    arena_.execute([&] { oneapi::tbb::this_task_arena::isolate(job); });
    const auto used = clock_() - start;
    job = nullptr;  // what it holds is released before anyone can see the strand idle
    lock.lock();
    strand->used_ += used;
    strand->fresh_ = false;
    if (strand->jobs_.empty()) {
      strand->ready_ = false;
    } else {
      line_.push_back(strand);
      wake_.notify_one();
    }
  }
}

}  // namespace holdfast::server
