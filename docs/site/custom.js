// The list of pages is longer than a window: start where the present page is visible.
document.addEventListener("DOMContentLoaded", () => {
  const list = document.querySelector(".sidebar-scroll");
  const page = list && list.querySelector(".current-page");
  if (page) {
    const top = page.getBoundingClientRect().top - list.getBoundingClientRect().top - list.clientHeight / 2;
    list.scrollTo({top: Math.max(0, top), behavior: "instant"});
  }
});
