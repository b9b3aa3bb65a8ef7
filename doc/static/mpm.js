/* This file is part of the MPM package for LAMMPS, distributed under the GNU
   General Public License, version 2; see the file LICENSE. */

// groups of pages in the navigation are closed, but the one of this page, until one clicks on their name
document.addEventListener("DOMContentLoaded", function () {
  const captions = document.querySelectorAll(".wy-menu-vertical p.caption");
  const here = Array.from(captions).some((c) => c.nextElementSibling.querySelector(".current"));
  captions.forEach(function (caption) {
    if (here && !caption.nextElementSibling.querySelector(".current")) caption.classList.add("closed");
    caption.addEventListener("click", () => caption.classList.toggle("closed"));
  });
});
