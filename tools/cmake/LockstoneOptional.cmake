# Libraries that the project is better with and builds without.

# lockstone_optional(OPTION PACKAGE purpose): sets `with_PACKAGE` in lower case in the caller. OPTION
# is ON, OFF or AUTO: when the library is at hand. Cross builds link none by themselves.
function(lockstone_optional option package purpose)
  set(${option} AUTO CACHE STRING "${purpose}: ON, OFF, or AUTO (when the library is there)")
  set(with ${${option}})
  if(with STREQUAL "AUTO")
    set(with OFF)
    if(NOT CMAKE_CROSSCOMPILING)
      find_package(${package} QUIET)
      set(with ${${package}_FOUND})
    endif()
    if(NOT with)
      message(STATUS "${purpose}: left out, ${package} is not at hand")
    endif()
  elseif(with)
    find_package(${package} REQUIRED)
  endif()
  string(TOLOWER ${package} name)
  set(with_${name} ${with} PARENT_SCOPE)
endfunction()
