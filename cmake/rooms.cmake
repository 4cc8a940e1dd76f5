# What every target of the project shares.
add_library(diaphane_flags INTERFACE)
target_compile_options(diaphane_flags INTERFACE -Wall -Wextra -Wno-missing-field-initializers)
if(DIAPHANE_SANITIZE)
  # Stacks need lines, not variables.
  target_compile_options(diaphane_flags INTERFACE -fsanitize=${DIAPHANE_SANITIZE} -fno-omit-frame-pointer -O1 -g1)
  target_link_options(diaphane_flags INTERFACE -fsanitize=${DIAPHANE_SANITIZE})
  if(DIAPHANE_SANITIZE MATCHES "thread")
    # Protobuf's maps have other members where this is defined, and the packaged library was built without. libstdc++ may know.
    target_compile_options(diaphane_flags INTERFACE -U__SANITIZE_THREAD__ -D_GLIBCXX_TSAN=1)
  endif()
endif()

# What runs once and briefly (generated code, command lines, tests) is compiled a third faster so.
set(DIAPHANE_BRIEF_CODE $<$<CONFIG:Release>:-O1>)

# diaphane_room(NAME dependency...): one server room, every .cc below its folder but main.cc, one library (headers alone
# where there is no .cc).
function(diaphane_room name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cc)
  list(FILTER sources EXCLUDE REGEX "/main\\.cc$")
  if(sources)
    add_library(diaphane_${name} STATIC ${sources})
    target_include_directories(diaphane_${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
    target_link_libraries(diaphane_${name} PUBLIC diaphane_flags ${ARGN})
  else()
    add_library(diaphane_${name} INTERFACE)
    target_include_directories(diaphane_${name} INTERFACE ${CMAKE_CURRENT_SOURCE_DIR})
    target_link_libraries(diaphane_${name} INTERFACE diaphane_flags ${ARGN})
  endif()
endfunction()
