// SPDX-License-Identifier: GPL-3.0-or-later
// ScratchArena: memory for one calculation, in large pages, given back all at once.
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
class ScratchArena {
public:
    /// `expected` bytes in all; it grows beyond that.
    explicit ScratchArena(size_t expected);
    ~ScratchArena();
    ScratchArena(const ScratchArena&) = delete;
    ScratchArena& operator=(const ScratchArena&) = delete;

    void* take(size_t bytes);
    void give_back(void* start, size_t bytes);
    /// This thread's latest; null when there is none.
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
    std::vector<FreeBlock> holes_;  // given back; few
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
