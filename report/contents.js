// On a narrow screen the list of contents covers the page: a choice closes it, and so does Escape.
const contents = document.querySelector("nav.contents details");
contents.addEventListener("click", (event) => {
  if (event.target.closest("a")) contents.open = false;
});
contents.addEventListener("keydown", (event) => {
  if (event.key !== "Escape" || !contents.open) return;
  contents.open = false;
  contents.querySelector("summary").focus();
});
