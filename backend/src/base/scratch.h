// SPDX-License-Identifier: GPL-3.0-or-later
// Scratch: memory for one calculation, in large pages, given back all at once.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace lodestone {

/// As long as it lives, scratch vectors that this thread makes take their memory from it, one after
/// the other, and a page fault for 2 MB instead of one for 4 KB. What they give back others get
/// before what was never touched. They must not outlive it.
class Scratch {
public:
    /// `expected` bytes in all; it grows beyond that.
    explicit Scratch(size_t expected);
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    void* take(size_t bytes);
    void give_back(void* start, size_t bytes);
    /// This thread's latest; null when there is none.
    static Scratch* current();

private:
    struct Block {
        std::byte* start;
        size_t size;
        size_t alignment;
    };
    struct Hole {
        std::byte* start;
        size_t size;
    };
    void grow(size_t bytes);

    Scratch* before_;
    std::vector<Block> blocks_;
    std::vector<Hole> holes_;  // given back; few
    std::byte* next_ = nullptr;
    std::byte* end_ = nullptr;
    size_t expected_;
};

/// Takes from the thread's scratch, else as std::allocator does. resize() leaves plain numbers as
/// they are.
template <typename T>
class ScratchAllocator {
public:
    using value_type = T;
    ScratchAllocator() : scratch_(Scratch::current()) {}
    template <typename U>
    ScratchAllocator(const ScratchAllocator<U>& other) : scratch_(other.scratch()) {}

    T* allocate(size_t count) {
        if (scratch_ == nullptr)
            return static_cast<T*>(
                ::operator new (count * sizeof(T), std::align_val_t{alignof(T)}));
        if (count > ~size_t{0} / sizeof(T))
            throw std::bad_alloc();
        return static_cast<T*>(scratch_->take(count * sizeof(T)));
    }
    void deallocate(T* start, size_t count) {
        if (scratch_ == nullptr)
            ::operator delete (start, std::align_val_t{alignof(T)});
        else
            scratch_->give_back(start, count * sizeof(T));
    }
    template <typename U, typename... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        if constexpr (sizeof...(Arguments) == 0)
            ::new (static_cast<void*>(at)) U;
        else
            ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }

    Scratch* scratch() const { return scratch_; }
    bool operator==(const ScratchAllocator& other) const { return scratch_ == other.scratch_; }

private:
    Scratch* scratch_;
};

template <typename T>
using ScratchVector = std::vector<T, ScratchAllocator<T>>;

}  // namespace lodestone
