// A replacement of the part of oneTBB that Lobelia uses, by plain threads: for `./test races`.
//
// The thread sanitizer must see every synchronisation. Debian's TBB is compiled without it: it would report the
// hand-over from one task to the next as a race, and a suppression of that also hides every real race inside a loop's
// body. Here each loop starts and joins its own threads, and distributes its work by a relaxed counter: only starting
// and joining order the bodies of a loop, so unordered accesses are detected.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {
namespace by_threads {

/// Maximum number of concurrent threads, including the callers' own.
inline constexpr std::size_t k_automatic = 4;
inline constexpr std::size_t k_slots = 64;

inline std::atomic<std::size_t> global_limit{k_slots};  // see global_control
inline thread_local std::size_t arena_limit = k_automatic;
inline thread_local std::size_t slot = 0;  // this thread's place in an enumerable_thread_specific

/// Places for running threads. The first is for threads that no loop started.
class Slots {
  public:
    /// Returns a free place, or 0 if all are taken.
    static std::size_t take() {
        const std::lock_guard lock(mutex_);
        const auto free = static_cast<std::size_t>(std::countr_one(taken_));
        if (free >= k_slots) return 0;
        taken_ |= std::uint64_t{1} << free;
        return free;
    }
    static void give_back(std::size_t place) {
        const std::lock_guard lock(mutex_);
        taken_ &= ~(std::uint64_t{1} << place);
    }

  private:
    static inline std::mutex mutex_;
    static inline std::uint64_t taken_ = 1;
};

/// Calls run(i) for every i below `count`, on several threads.
template <class Run>
void for_each_index(std::size_t count, const Run& run) {
    const std::size_t limit = std::min({arena_limit, global_limit.load(), count});
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&] {
        try {
            for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) run(i);
        } catch (...) {
            next.store(count, std::memory_order_relaxed);
            const std::lock_guard lock(failure_mutex);
            failure = std::current_exception();
        }
    };
    std::vector<std::pair<std::thread, std::size_t>> others;
    for (std::size_t k = 1; k < limit; ++k) {
        const std::size_t place = Slots::take();
        if (place == 0) break;
        others.emplace_back(std::thread([&work, place, arena = arena_limit] {
                                slot = place;
                                arena_limit = arena;
                                work();
                            }),
                            place);
    }
    work();
    for (auto& [thread, place] : others) {
        thread.join();
        Slots::give_back(place);
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace by_threads

template <class Index>
class blocked_range {
  public:
    blocked_range(Index begin, Index end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
    [[nodiscard]] Index begin() const { return begin_; }
    [[nodiscard]] Index end() const { return end_; }
    [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
    [[nodiscard]] std::size_t grainsize() const { return grain_; }

  private:
    Index begin_, end_;
    std::size_t grain_;
};

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
    if (first < last)
        by_threads::for_each_index(static_cast<std::size_t>(last - first),
                                   [&](std::size_t i) { body(static_cast<Index>(first + static_cast<Index>(i))); });
}

template <class Index, class Body>
void parallel_for(const blocked_range<Index>& range, const Body& body) {
    const std::size_t grain = range.grainsize();
    by_threads::for_each_index((range.size() + grain - 1) / grain, [&](std::size_t i) {
        const Index begin = range.begin() + static_cast<Index>(i * grain);
        body(blocked_range<Index>(begin, std::min(range.end(), begin + static_cast<Index>(grain)), grain));
    });
}

/// Like TBB's: halves down to the grain, with results joined in the order of the tree.
template <class Index, class Value, class Body, class Join>
Value parallel_deterministic_reduce(const blocked_range<Index>& range, const Value& identity, const Body& body,
                                    const Join& join) {
    std::vector<blocked_range<Index>> leaves;
    const auto split = [&](const auto& again, Index begin, Index end) -> void {
        if (static_cast<std::size_t>(end - begin) <= range.grainsize()) {
            leaves.emplace_back(begin, end, range.grainsize());
            return;
        }
        const Index middle = begin + (end - begin) / 2;
        again(again, begin, middle);
        again(again, middle, end);
    };
    split(split, range.begin(), range.end());
    std::vector<Value> values(leaves.size(), identity);
    by_threads::for_each_index(leaves.size(), [&](std::size_t i) { values[i] = body(leaves[i], identity); });
    std::size_t leaf = 0;
    const auto joined = [&](const auto& again, Index begin, Index end) -> Value {
        if (static_cast<std::size_t>(end - begin) <= range.grainsize()) return values[leaf++];
        const Index middle = begin + (end - begin) / 2;
        const Value left = again(again, begin, middle);
        return join(left, again(again, middle, end));
    };
    return joined(joined, range.begin(), range.end());
}

template <class Items, class Less>
void parallel_sort(Items& items, const Less& less) {
    std::sort(items.begin(), items.end(), less);
}

/// A value per thread. A thread's place is found without a lock, which would order the bodies.
template <class Value>
class enumerable_thread_specific {
  public:
    enumerable_thread_specific() requires std::default_initializable<Value>
        : make_([] { return std::make_unique<Value>(); }) {}
    template <class Make>
    explicit enumerable_thread_specific(Make make)
        : make_([make] { return std::unique_ptr<Value>(new Value(make())); }) {}

    [[nodiscard]] Value& local() {
        std::unique_ptr<Value>& value = values_[by_threads::slot];
        if (!value) value = make_();
        return *value;
    }
    template <class Visit>
    void combine_each(const Visit& visit) {
        for (const auto& value : values_)
            if (value) visit(*value);
    }

    class iterator {
      public:
        iterator(enumerable_thread_specific& all, std::size_t at) : all_(all), at_(at) { skip(); }
        Value& operator*() const { return *all_.values_[at_]; }
        iterator& operator++() {
            ++at_;
            skip();
            return *this;
        }
        bool operator!=(const iterator& other) const { return at_ != other.at_; }

      private:
        void skip() {
            while (at_ < by_threads::k_slots && !all_.values_[at_]) ++at_;
        }
        enumerable_thread_specific& all_;
        std::size_t at_;
    };
    iterator begin() { return {*this, 0}; }
    iterator end() { return {*this, by_threads::k_slots}; }

  private:
    std::function<std::unique_ptr<Value>()> make_;
    std::array<std::unique_ptr<Value>, by_threads::k_slots> values_;
};

template <class Value>
using combinable = enumerable_thread_specific<Value>;

class task_arena {
  public:
    static constexpr int automatic = -1;
    explicit task_arena(int threads = automatic)
        : limit_(threads == automatic ? by_threads::k_automatic : static_cast<std::size_t>(threads)) {}
    template <class Run>
    auto execute(const Run& run) {
        struct Restore {
            std::size_t before;
            ~Restore() { by_threads::arena_limit = before; }
        };
        const Restore restore{std::exchange(by_threads::arena_limit, limit_)};
        return run();
    }

  private:
    std::size_t limit_;
};

class global_control {
  public:
    enum parameter { max_allowed_parallelism };
    global_control(parameter, std::size_t threads) : before_(by_threads::global_limit.exchange(threads)) {}
    ~global_control() { by_threads::global_limit = before_; }
    static std::size_t active_value(parameter) { return by_threads::global_limit; }
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;

  private:
    std::size_t before_;
};

}  // namespace tbb
