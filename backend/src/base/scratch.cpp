// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/scratch.h"

#include <algorithm>
#include <sys/mman.h>

namespace lodestone {
namespace {

/// The bytes of a large page.
/// Law: x86-64 and the kernel's transparent huge pages have 2 MB.
constexpr size_t kPage = size_t{2} << 20u;
/// The bytes to which every address is aligned.
/// Law: a cache line, and the widest vector register.
constexpr size_t kAlignment = 64;

thread_local ScratchArena* latest = nullptr;

size_t rounded_up(size_t bytes, size_t unit) {
    return (bytes + unit - 1) / unit * unit;
}

}  // namespace

ScratchArena::ScratchArena(size_t expected) : before_(latest), expected_(expected) {
    latest = this;
}

ScratchArena::~ScratchArena() {
    for (const MemoryBlock& block : blocks_)
        ::operator delete (block.start, std::align_val_t{block.alignment});
    latest = before_;
}

ScratchArena* ScratchArena::current() {
    return latest;
}

void* ScratchArena::take(size_t bytes) {
    if (bytes > ~size_t{0} / 2)
        throw std::bad_alloc();
    bytes = rounded_up(bytes, kAlignment);
    auto best = holes_.end();
    for (auto hole = holes_.begin(); hole != holes_.end(); ++hole) {
        if (hole->size >= bytes && (best == holes_.end() || hole->size < best->size))
            best = hole;
    }
    if (best != holes_.end()) {
        std::byte* start = best->start;
        best->start += bytes;
        best->size -= bytes;
        if (best->size == 0)
            holes_.erase(best);
        return start;
    }
    if (next_ == nullptr || bytes > static_cast<size_t>(end_ - next_))
        grow(bytes);
    std::byte* start = next_;
    next_ += bytes;
    return start;
}

void ScratchArena::give_back(void* start, size_t bytes) {
    auto* first = static_cast<std::byte*>(start);
    bytes = rounded_up(bytes, kAlignment);
    if (bytes == 0)
        return;
    if (first + bytes == next_) {
        next_ = first;
        return;
    }
    // Blocks that are remembered as given back.
    // Taste: a larger value uses more memory again, for a longer search every time.
    constexpr size_t kMostHoles = 64;
    for (FreeBlock& hole : holes_) {  // a block beside a hole becomes part of it
        if (hole.start + hole.size == first || first + bytes == hole.start) {
            hole.start = std::min(hole.start, first);
            hole.size += bytes;
            return;
        }
    }
    if (holes_.size() < kMostHoles)
        holes_.push_back({first, bytes});
}

void ScratchArena::grow(size_t bytes) {
    // Memory that is never touched costs nothing, so a block may be generous.
    size_t size = std::max(bytes, blocks_.empty() ? expected_ : expected_ / 2);
    const bool large = size >= kPage / 4;
    const size_t alignment = large ? kPage : kAlignment;
    size = rounded_up(size, alignment);
    blocks_.reserve(blocks_.size() + 1);
    holes_.reserve(64);
    auto* start = static_cast<std::byte*>(::operator new (size, std::align_val_t{alignment}));
#ifdef MADV_HUGEPAGE
    if (large)
        madvise(start, size, MADV_HUGEPAGE);  // a wish: without it, it is slower
#endif
    blocks_.push_back({start, size, alignment});
    next_ = start;
    end_ = start + size;
}

}  // namespace lodestone
