# Derivations allocate and free small pieces all the time: with mimalloc they take a quarter less time than with glibc's
# malloc, and as much memory. It is left out where it is not installed, and under the sanitizers, which have their own.
option(EOMGEN_MIMALLOC "Link the programs with mimalloc where it is installed" ON)
if(EOMGEN_MIMALLOC)
  find_package(mimalloc QUIET)
endif()

# eomgen_allocator(TARGET VISIBILITY): programs, or what programs are linked with.
function(eomgen_allocator target visibility)
  if(TARGET mimalloc)
    # Nothing of it is called by name, so a linker may think that it is not needed.
    target_link_options(${target} ${visibility} LINKER:--no-as-needed)
    target_link_libraries(${target} ${visibility} mimalloc)
  endif()
endfunction()
