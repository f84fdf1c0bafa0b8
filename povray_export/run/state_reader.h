// SPDX-License-Identifier: GPL-3.0-or-later
// StateReader: the pixels in the file in which POV-Ray keeps what it has drawn, to go on from.
#pragma once

#include "povray_export/run/live_picture.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace lodestone::povray {

/// Takes the file piece by piece, as it grows, and draws what it holds into a live picture. Nothing
/// in the file is trusted; its memory is bounded. It is used on one thread.
class StateReader {
public:
    explicit StateReader(LivePicture& picture) : picture_(picture) {}

    /// Takes the next bytes. A message that is not whole yet waits for the rest of it; what would
    /// paint more than a few million pixels waits for the next call.
    void read(std::string_view piece);
    /// True while a call is to come with nothing new: whole messages wait.
    bool behind() const { return behind_; }
    /// True once the file turned out to be something else; what comes then is not looked at.
    bool broken() const { return broken_; }

private:
    void stop_reading();

    LivePicture& picture_;
    std::string pending_;  // the bytes of a message that is not whole yet
    bool past_head_ = false;
    bool behind_ = false;
    bool broken_ = false;
};

}  // namespace lodestone::povray
