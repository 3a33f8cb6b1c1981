# Whether a command leaves the variables of its caller alone: remember_variables(), the command,
# expect_unchanged_variables(). The values are kept in global properties, which are no variables.
function (remember_variables)
  get_cmake_property(names VARIABLES)
  set_property(GLOBAL PROPERTY remembered "${names}")
  foreach (name IN LISTS names)
    set_property(GLOBAL PROPERTY "remembered ${name}" "${${name}}")
  endforeach ()
endfunction ()

function (expect_unchanged_variables)
  get_cmake_property(names VARIABLES)
  get_property(names_before GLOBAL PROPERTY remembered)
  list(APPEND names ${names_before})
  list(REMOVE_DUPLICATES names)
  # Those of every function call, and those that find_package sets by its contract.
  list(FILTER names EXCLUDE REGEX "^(ARG[CNV]|CMAKE_CURRENT_FUNCTION|CMAKE_MATCH_|HybridRayTracing_)")
  foreach (name IN LISTS names)
    get_property(value GLOBAL PROPERTY "remembered ${name}")
    # The cache is where CMake keeps what it has found; an entry is no variable of the caller's.
    if (NOT "${${name}}" STREQUAL "${value}" AND
        (name IN_LIST names_before OR NOT DEFINED CACHE{${name}}))
      message(SEND_ERROR "${name} was '${value}' and is '${${name}}'")
    endif ()
  endforeach ()
endfunction ()
