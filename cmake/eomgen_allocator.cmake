# Derivations allocate and free many small blocks: with mimalloc they take a quarter less time than with glibc's malloc,
# and the same memory. It is not used if it is not installed, or with the sanitizers, which have their own allocator.
option(EOMGEN_MIMALLOC "Link the programs with mimalloc where it is installed" ON)
if(EOMGEN_MIMALLOC)
  find_package(mimalloc QUIET)
endif()

# eomgen_allocator(TARGET VISIBILITY): links the allocator into a program, or into a library of programs.
function(eomgen_allocator target visibility)
  if(TARGET mimalloc)
    # No code refers to its symbols, so a linker may drop it.
    target_link_options(${target} ${visibility} LINKER:--no-as-needed)
    target_link_libraries(${target} ${visibility} mimalloc)
  endif()
endfunction()
