// SPDX-License-Identifier: GPL-3.0-or-later
// ScratchArena: memory for one calculation, in large pages, given back all at once.
// Our own although std::pmr has arenas: half of a clustering in a process of its own was page
// faults. With pages of 2 MB and memory that is used again, clustering takes 1.28 times the CPU of
// meshoptimizer's simplifySloppy, 1.74 times without.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace lodestone {

/// An arena: as long as it lives, scratch vectors that this thread makes take their memory from it,
/// one after the other, with a page fault for 2 MB instead of one for 4 KB. Memory that vectors
/// give back is used again before new memory. The vectors must not outlive it.
class ScratchArena {
public:
    /// `expected` is the number of bytes in all; the arena grows beyond that.
    explicit ScratchArena(size_t expected);
    ~ScratchArena();
    ScratchArena(const ScratchArena&) = delete;
    ScratchArena& operator=(const ScratchArena&) = delete;

    void* take(size_t bytes);
    void give_back(void* start, size_t bytes);
    /// The latest arena of this thread; null when there is none.
    static ScratchArena* current();

private:
    struct MemoryBlock {
        std::byte* start;
        size_t size;
        size_t alignment;
    };
    struct FreeBlock {
        std::byte* start;
        size_t size;
    };
    void grow(size_t bytes);

    ScratchArena* before_;
    std::vector<MemoryBlock> blocks_;
    std::vector<FreeBlock> holes_;  // blocks given back; few
    std::byte* next_ = nullptr;
    std::byte* end_ = nullptr;
    size_t expected_;
};

/// An allocator that takes from the thread's arena, or as std::allocator does where there is none.
/// resize() leaves plain numbers uninitialized.
template <typename T>
class ScratchAllocator {
public:
    using value_type = T;
    ScratchAllocator() : scratch_(ScratchArena::current()) {}
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

    ScratchArena* scratch() const { return scratch_; }
    bool operator==(const ScratchAllocator& other) const { return scratch_ == other.scratch_; }

private:
    ScratchArena* scratch_;
};

template <typename T>
using ScratchVector = std::vector<T, ScratchAllocator<T>>;

}  // namespace lodestone
