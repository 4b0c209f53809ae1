# Writes OUT, a header with a hash of SOURCES: a cache of what this code made is of no use to any other.
set(hashes "")
foreach(source IN LISTS SOURCES)
  file(SHA256 ${source} hash)
  string(APPEND hashes ${hash})
endforeach()
string(SHA256 id "${hashes}")
string(SUBSTRING ${id} 0 32 id)
file(WRITE ${OUT} "// Made by preparation_id.cmake.
#pragma once

#include <string_view>

namespace phantom::scene {

inline constexpr std::string_view preparation_id = \"${id}\";

} // namespace phantom::scene
")
