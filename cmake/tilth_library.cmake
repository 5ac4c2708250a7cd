# SPDX-License-Identifier: BSD-3-Clause
# tilth_library(<room> SOURCES ... HEADERS ... PUBLIC ... PRIVATE ...): one static library per room.
function(tilth_library layer)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  add_library(tilth_${layer} STATIC ${arg_SOURCES})
  add_library(tilth::${layer} ALIAS tilth_${layer})
  target_sources(tilth_${layer} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
                                                        FILES ${arg_HEADERS})
  target_compile_features(tilth_${layer} PUBLIC cxx_std_20)
  target_link_libraries(tilth_${layer} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  set_target_properties(tilth_${layer} PROPERTIES CXX_EXTENSIONS OFF)
endfunction()
