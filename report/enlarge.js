// On a narrow screen a figure can be enlarged, and is then moved sideways under a finger. A style shows the button there.
for (const region of document.querySelectorAll(".picture")) {
  const button = document.createElement("button");
  Object.assign(button, { type: "button", className: "enlarge", textContent: "Enlarge the figure" });
  button.setAttribute("aria-pressed", "false");
  button.addEventListener("click", () => button.setAttribute("aria-pressed", String(region.classList.toggle("large"))));
  region.after(button);
}
