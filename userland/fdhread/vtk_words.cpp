// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhread/vtk_words.hpp"

#include <algorithm>
#include <string_view>

#include <vtkObjectFactory.h>

namespace phantom::fdhread {

vtkStandardNewMacro(VtkWords);

void VtkWords::DisplayErrorText(const char* text)
{
    if (!first_error_.empty())
        return;
    // "ERROR: In FILE, line N\nvtkClass (0x...): what is wrong\n\n"
    std::string_view words = text;
    if (const auto at = words.find("): "); at != std::string_view::npos)
        words.remove_prefix(at + 3);
    first_error_ = words.substr(0, 200);
    std::replace(first_error_.begin(), first_error_.end(), '\n', ' ');
    const auto last = first_error_.find_last_not_of(" .");
    first_error_.resize(last == std::string::npos ? 0 : last + 1);
    if (first_error_.empty())
        first_error_ = "an error that it does not describe";
}

} // namespace phantom::fdhread
